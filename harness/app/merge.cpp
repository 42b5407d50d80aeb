// `penumbra merge`: shards of a sweep become one run.
#include "run/merge.h"

#include <fmt/format.h>

#include <memory>

#include "app/after_run.h"
#include "app/commands.h"

namespace penumbra {

void add_merge(CLI::App& app, Context& context) {
  struct Options {
    std::vector<std::string> runs;
    std::string out;
    bool no_report = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub = app.add_subcommand("merge", "Join the shards of a sweep into one run");
  sub->add_option("RUN", options->runs, "Folders of the shards' results")->required();
  sub->add_option("--out", options->out, "Folder of the joined results")->required();
  sub->add_flag("--no-report", options->no_report, "Make neither plots nor report");
  sub->callback([options, &context] {
    const run::MergeOutcome outcome =
        run::merge_runs({options->runs.begin(), options->runs.end()}, options->out);
    const int written = after_run(options->out, context, !options->no_report);
    for (const std::string& machine : outcome.machines) fmt::print("machine: {}\n", machine);
    fmt::print("{} points of {} runs\n", outcome.points, options->runs.size());
    context.exit_code = written != exit_done ? written : outcome.failed ? exit_points_failed : exit_done;
  });
}

}  // namespace penumbra
