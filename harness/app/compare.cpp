// `penumbra compare` and `penumbra baseline`.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "app/commands.h"
#include "compare/baseline.h"
#include "compare/comparison.h"
#include "compare/output.h"
#include "core/error.h"
#include "report/comparison.h"
#include "run/files.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

struct CompareArguments {
  std::string baseline, current, thresholds, junit, report;
  bool as_json = false, any_machine = false;
};

// A path, or the name of a committed baseline ("gate").
fs::path find_baseline(const std::string& name, const Context& context) {
  std::error_code error;
  if (fs::exists(name, error)) return name;
  std::vector<std::string> names;
  for (const fs::path& root : context.roots) {
    const fs::path folder = root / "results/baselines";
    if (fs::is_regular_file(folder / (name + ".json"), error)) return folder / (name + ".json");
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      const std::string file = entry.path().filename().string();
      if (file.ends_with(".json") && !file.ends_with(".thresholds.json"))
        names.push_back(entry.path().stem().string());
    }
  }
  throw InputError(
      fmt::format("{}: no such run, results file or baseline.{}", name, suggestion(name, names)));
}

// The file that stands beside a baseline, gate.thresholds.json beside gate.json.
fs::path thresholds_beside(const fs::path& baseline) {
  std::error_code error;
  const fs::path beside = baseline.parent_path() / (baseline.stem().string() + ".thresholds.json");
  return fs::is_regular_file(baseline, error) && fs::is_regular_file(beside, error) ? beside : fs::path();
}

void add_unique(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

// Names that a rule may use: all that the program knows, and those that the two runs have.
compare::KnownNames known_names(const Context& context,
                                std::initializer_list<const compare::RunResults*> runs) {
  compare::KnownNames known;
  known.scenes = context.scene_names();
  known.params = {"resolution",    "light",         "camera", "light_size",     "mask_size",
                  "light_samples", "light_pattern", "seed",   "light_rotation", "accumulate"};
  for (const TechniqueInfo& info : context.registry) {
    known.techniques.push_back(info.name);
    for (const ParamInfo& p : info.params) add_unique(known.params, p.name);
  }
  for (const compare::RunResults* run : runs)
    for (const auto& point : run->points) {
      add_unique(known.techniques, point.at("technique"));
      add_unique(known.scenes, point.at("scene"));
      for (const auto& [name, value] : point.at("params").items()) add_unique(known.params, name);
    }
  return known;
}

void write_report(const fs::path& folder, const compare::Comparison& result,
                  const compare::RunResults& baseline, const compare::RunResults& current) {
  const ReportSummary summary = write_comparison_report(compare::page_data(result, baseline, current),
                                                        baseline.folder, current.folder, folder);
  for (const std::string& warning : summary.warnings) fmt::print(stderr, "penumbra: warning: {}\n", warning);
  fmt::print(stderr, "report: {}\n", summary.index.string());
}

void compare_command(const CompareArguments& arguments, Context& context) {
  const fs::path baseline_path = find_baseline(arguments.baseline, context);
  const compare::RunResults baseline = compare::read_results(baseline_path);
  const compare::RunResults current = compare::read_results(arguments.current);
  const fs::path file =
      !arguments.thresholds.empty() ? fs::path(arguments.thresholds) : thresholds_beside(baseline_path);
  const compare::Thresholds thresholds =
      file.empty()
          ? compare::default_thresholds()
          : compare::read_thresholds(JsonDocument::read(file), known_names(context, {&baseline, &current}));
  const compare::Comparison result = compare::compare(baseline, current, thresholds, {arguments.any_machine});
  if (arguments.as_json)
    fmt::print("{}\n",
               compare::to_json(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  else
    fmt::print("{}", compare::table(result));
  if (!arguments.junit.empty()) run::write_text(arguments.junit, compare::junit_xml(result));
  if (!arguments.report.empty()) write_report(arguments.report, result, baseline, current);
  if (!result.error.empty()) throw InputError(result.error);
  context.exit_code = result.bad() ? exit_points_failed : exit_done;
}

void update_command(const std::string& run, std::string name, const std::string& folder) {
  const compare::RunResults results = compare::read_results(run);
  if (name.empty()) name = results.run.value("name", "");
  if (name.empty() || name.find('/') != std::string::npos || name.starts_with('.'))
    throw InputError(fmt::format("--name: found '{}', expected a file name without a folder.", name));
  const std::string text = compare::baseline_text(results);
  run::make_folder(folder);
  const fs::path path = fs::path(folder) / (name + ".json");
  run::write_text(path, text);
  fmt::print("{}: {} points\n", path.string(), results.points.size());
}

}  // namespace

void add_compare(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* sub = app.add_subcommand("compare", "Judge a run against another, by thresholds");
  sub->add_option("BASELINE", arguments->baseline,
                  "Run folder, results file, or name under results/baselines/")
      ->required();
  sub->add_option("CURRENT", arguments->current, "Run folder or results file")->required();
  sub->add_option("--thresholds", arguments->thresholds,
                  "Rules (default: NAME.thresholds.json beside a baseline NAME.json, else built-in ones)");
  sub->add_option("--junit", arguments->junit, "Also write JUnit XML");
  sub->add_option("--report", arguments->report,
                  "Also write a page of both runs side by side, with their pictures, into this folder");
  sub->add_flag("--json", arguments->as_json, "Every finding as a JSON object");
  sub->add_flag("--any-machine", arguments->any_machine, "Judge times between different machines too");
  sub->callback([arguments, &context] { compare_command(*arguments, context); });
}

void add_baseline(CLI::App& app, Context&) {
  struct Options {
    std::string run, name, folder = "results/baselines";
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("baseline", "Committed results that later runs are compared with");
  sub->require_subcommand(1);
  CLI::App* update = sub->add_subcommand("update", "Write or renew the baseline of a finished run");
  update->add_option("RUN", options->run, "Folder of results")->required();
  update->add_option("--name", options->name, "Its name (default: the config's)");
  update->add_option("--dir", options->folder, "Where baselines are (default: results/baselines)");
  update->callback([options] { update_command(options->run, options->name, options->folder); });
}

}  // namespace penumbra
