#include <fmt/format.h>

#include <map>
#include <set>

#include "app/commands.h"
#include "config/plan.h"
#include "core/error.h"
#include "run/scene_check.h"
#include "run/worker.h"

namespace penumbra {
namespace {

std::string summary(const Plan& plan) {
  std::set<std::string> scenes, techniques;
  for (const Point& p : plan.points) scenes.insert(p.scene), techniques.insert(p.technique);
  return fmt::format("{} points, {} scenes, {} techniques", plan.points.size(), scenes.size(),
                     techniques.size());
}

}  // namespace

void add_validate(CLI::App& app, Context& context) {
  struct Options {
    std::vector<std::string> configs;
    PlanOptions plan;
    bool no_scenes = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* sub =
      app.add_subcommand("validate", "Check configs and say what they expand to, without running anything");
  sub->add_option("config", options->configs, "Config files or names")->required();
  sub->add_option("--set", options->plan.set, "/pointer=value: replaces one value of the config")
      ->take_all()
      ->allow_extra_args(false);
  sub->add_option("--filter", options->plan.filter, "Only points whose key matches this regular expression");
  sub->add_flag("--no-scenes", options->no_scenes,
                "Do not load the scenes; that their meshes are there is checked");
  sub->callback([options, &context] {
    // All are checked before the first error ends the program, so that one call shows every wrong file.
    std::string errors;
    for (const std::string& config : options->configs) {
      try {
        const auto path = context.find_config(config);
        const Plan plan = load_plan(path, options->plan, context.registry, context.scene_search);
        if (!options->no_scenes)
          for (const std::string& remark :
               run::check_scenes(plan.points, context.scene_search, run::default_cache_folder()))
            fmt::print(stderr, "penumbra: {}\n", remark);
        fmt::print("{}: ok, {}\n", path.string(), summary(plan));
      } catch (const InputError& e) {
        errors += (errors.empty() ? "" : "\n") + std::string(e.what());
      }
    }
    if (!errors.empty()) throw InputError(errors);
  });
}

}  // namespace penumbra
