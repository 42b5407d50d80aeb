// `penumbra run`, and the hidden `penumbra worker` that it starts.
#include <fmt/format.h>
#include <unistd.h>

#include <memory>

#include "app/after_run.h"
#include "app/commands.h"
#include "config/plan.h"
#include "core/error.h"
#include "gpu/device.h"
#include "run/progress.h"
#include "run/provenance.h"
#include "run/scene_check.h"
#include "run/schedule.h"
#include "run/supervisor.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  std::string config, out, filter, shard;
  std::vector<std::string> set;
  bool resume = false, dry_run = false, no_images = false, no_report = false, quiet = false;
};

// "2/8" -> {2, 8}.
std::pair<int, int> parse_shard(const std::string& text) {
  int index = 0, count = 0, used = 0;
  if (std::sscanf(text.c_str(), "%d/%d%n", &index, &count, &used) != 2 ||
      used != static_cast<int>(text.size()))
    throw InputError(fmt::format("--shard: found '{}', expected I/N, for instance 1/4.", text));
  return {index, count};
}

void print_plan(const Plan& plan, const run::CostModel& costs) {
  double total = 0;
  for (const Point& p : plan.points) {
    fmt::print("{}  {}\n", p.id, p.key());
    total += costs.expected_s(p);
  }
  fmt::print("{} points, {} views, roughly {} (references apart).\n", plan.points.size(),
             run::batches(plan.points).size(), run::duration_text(total));
}

run::RunOptions run_options(const RunArguments& arguments, const Context& context, const Plan& plan) {
  run::RunOptions options;
  // A folder of one's own for each run, in the order of their start.
  options.out = !arguments.out.empty() ? fs::path(arguments.out)
                                       : fs::path("results") / (plan.name + "-" + run::folder_time());
  options.resume = arguments.resume;
  options.quiet = arguments.quiet;
  options.shard = arguments.shard;
  options.command_line = context.command_line;
  options.worker.device = context.device;
  options.worker.threads = context.threads;
  options.worker.scene_search = context.scene_search;
  options.worker.reference_cache = run::default_cache_folder();
  options.worker_command = {fs::read_symlink("/proc/self/exe").string(), "worker"};
  return options;
}

int exit_code(const run::RunOutcome& outcome) {
  if (outcome.interrupted) return exit_interrupted;
  return outcome.failed + outcome.timed_out > 0 ? exit_points_failed : exit_done;
}

std::string summary(const run::RunOutcome& o) {
  std::string text = fmt::format("{} ok", o.ok);
  if (o.unsupported) text += fmt::format(", {} unsupported", o.unsupported);
  if (o.failed) text += fmt::format(", {} failed", o.failed);
  if (o.timed_out) text += fmt::format(", {} timed out", o.timed_out);
  if (o.kept) text += fmt::format("; {} of them kept from before", o.kept);
  if (o.interrupted) text += "; interrupted, --resume goes on";
  return text;
}

void run_command(const RunArguments& arguments, Context& context) {
  if (arguments.resume && arguments.out.empty())
    throw InputError("--resume: needs --out with the folder of the run that is to go on.");
  Plan plan = load_plan(context.find_config(arguments.config), {arguments.set, arguments.filter},
                        context.registry, context.scene_search);
  if (arguments.no_images) plan.images.clear();
  const run::CostModel costs(plan.measure, context.registry);
  if (!arguments.shard.empty()) {
    const auto [index, count] = parse_shard(arguments.shard);
    plan.points = run::shard(plan.points, index, count, costs);
  }
  if (arguments.dry_run) return print_plan(plan, costs);
  for (const std::string& remark :
       run::check_scenes(plan.points, context.scene_search, run::default_cache_folder()))
    fmt::print(stderr, "penumbra: {}\n", remark);
  gpu::require_device(context.device);  // before a folder is made for results that cannot come
  const run::RunOutcome outcome =
      run::run_plan(plan, run_options(arguments, context, plan), context.registry);
  const int written = after_run(outcome.folder, context, !outcome.interrupted && !arguments.no_report);
  fmt::print("{}\n", summary(outcome));
  context.exit_code = written != exit_done ? written : exit_code(outcome);
}

}  // namespace

void add_run(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* sub = app.add_subcommand("run", "Run a sweep config");
  sub->add_option("CONFIG", arguments->config, "Config file, or its name under configs/")->required();
  sub->add_option("--out", arguments->out, "Folder of the results (default: results/NAME-TIME)");
  sub->add_option("--filter", arguments->filter,
                  "Only points whose technique/scene/key=value,... match this expression");
  sub->add_option("--set", arguments->set, "/POINTER=JSON: change a value of the config")
      ->take_all()
      ->allow_extra_args(false);  // or it would take CONFIG too
  sub->add_option("--shard", arguments->shard, "I/N: the I-th of N parts of the sweep");
  sub->add_flag("--resume", arguments->resume, "Run only what is missing, failed, or out of date in --out");
  sub->add_flag("--dry-run", arguments->dry_run, "Print the plan and do nothing");
  sub->add_flag("--no-images", arguments->no_images, "Write no images, whatever the config asks for");
  sub->add_flag("--no-report", arguments->no_report, "Make neither plots nor report");
  sub->add_flag("--quiet", arguments->quiet, "No progress");
  sub->callback([arguments, &context] { run_command(*arguments, context); });

  CLI::App* worker = app.add_subcommand("worker", "Computes points for `run`; started by it");
  worker->group("");
  worker->callback([&context] { context.exit_code = run::worker_main(context.registry); });
}

}  // namespace penumbra
