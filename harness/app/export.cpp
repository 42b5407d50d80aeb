// `penumbra export`: a run's points in formats of others.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "core/error.h"
#include "image/atomic_file.h"
#include "run/files.h"
#include "run/journal.h"
#include "run/latex.h"
#include "run/results.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> formats{"csv", "google-benchmark", "latex", "pgfplots", "provenance"};

nlohmann::json header_of(const fs::path& folder) {
  const auto header = nlohmann::json::parse(run::read_text(folder / "run.json"), nullptr, false);
  if (!header.is_object())
    throw InputError(fmt::format("{}: not a run's header.", (folder / "run.json").string()));
  return header;
}

std::string exported(const fs::path& folder, const std::string& format, bool standalone) {
  if (std::ranges::find(formats, format) == formats.end())
    throw InputError(fmt::format("--format: found '{}', expected one of {}.{}", format,
                                 fmt::join(formats, ", "), suggestion(format, formats)));
  if (standalone && format != "latex" && format != "pgfplots")
    throw InputError(fmt::format("--standalone: makes a document of latex and pgfplots, not of {}.", format));
  const run::RecordSource source = [&](const auto& visit) { run::for_each_point(folder, visit); };
  if (format == "csv") {
    std::string text;
    run::write_csv(source, [&](const std::string& line) { text += line; });
    return text;
  }
  if (format == "google-benchmark")
    return run::google_benchmark_json(header_of(folder), source).dump(2) + "\n";
  if (format == "provenance") return run::provenance_text(header_of(folder), source);
  const std::string fragment = format == "latex" ? run::latex_table(source) : run::pgfplots_figure(source);
  return standalone ? run::latex_document(fragment) : fragment;
}

}  // namespace

void add_export(CLI::App& app, Context&) {
  struct Options {
    std::string run, format, out;
    bool standalone = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand(
      "export", "Write a run's points as csv, for Google Benchmark's tools, or for papers");
  sub->add_option("RUN", options->run, "Folder of results")->required();
  sub->add_option("--format", options->format, "csv|google-benchmark|latex|pgfplots|provenance")->required();
  sub->add_option("-o,--out", options->out, "File (default: standard output)");
  sub->add_flag("--standalone", options->standalone, "latex, pgfplots: a document that compiles as it is");
  sub->callback([options] {
    const std::string text = exported(options->run, options->format, options->standalone);
    if (options->out.empty())
      std::cout << text;
    else
      run::write_text(options->out, text);
  });
}

}  // namespace penumbra
