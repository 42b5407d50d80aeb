// `penumbra export`: a run's points in formats of others.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "core/error.h"
#include "image/atomic_file.h"
#include "run/files.h"
#include "run/journal.h"
#include "run/results.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

std::string exported(const fs::path& folder, const std::string& format) {
  const run::RecordSource source = [&](const auto& visit) { run::for_each_point(folder, visit); };
  if (format == "csv") {
    std::string text;
    run::write_csv(source, [&](const std::string& line) { text += line; });
    return text;
  }
  if (format == "google-benchmark") {
    const auto header = nlohmann::json::parse(run::read_text(folder / "run.json"), nullptr, false);
    if (!header.is_object())
      throw InputError(fmt::format("{}: not a run's header.", (folder / "run.json").string()));
    return run::google_benchmark_json(header, source).dump(2) + "\n";
  }
  const std::vector<std::string> formats{"csv", "google-benchmark"};
  throw InputError(
      fmt::format("--format: found '{}', expected one of {}.", format, fmt::join(formats, ", ")));
}

}  // namespace

void add_export(CLI::App& app, Context&) {
  struct Options {
    std::string run, format, out;
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("export", "Write a run's points as csv or for Google Benchmark's tools");
  sub->add_option("RUN", options->run, "Folder of results")->required();
  sub->add_option("--format", options->format, "csv|google-benchmark")->required();
  sub->add_option("-o,--out", options->out, "File (default: standard output)");
  sub->callback([options] {
    const std::string text = exported(options->run, options->format);
    if (options->out.empty())
      std::cout << text;
    else
      run::write_text(options->out, text);
  });
}

}  // namespace penumbra
