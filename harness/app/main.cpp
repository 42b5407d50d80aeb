// The program: global options, subcommands, and the one place where exceptions become messages and exit
// codes.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <iostream>

#include "app/commands.h"
#include "core/error.h"
#include "core/parallel.h"
#include "techniques/registry.h"

namespace penumbra {

namespace {

int message(int code, const std::string& text) {
  fmt::print(stderr, "penumbra: {}\n", text);
  return code;
}

// CLI11 says that an argument was not expected; this says which one was probably meant.
std::string unexpected_arguments(const CLI::App& app) {
  const std::vector<CLI::App*> given = app.get_subcommands();
  const std::vector<std::string> extras = app.remaining(true);
  const std::string extra = extras.empty() ? "" : extras.front();
  std::vector<std::string> candidates;
  if (extra.starts_with("-")) {
    std::vector<const CLI::App*> apps{&app};
    for (const CLI::App* sub : given) apps.insert(apps.begin(), sub);
    for (const CLI::App* a : apps)
      for (const CLI::Option* option : a->get_options())
        if (!option->get_lnames().empty()) candidates.push_back("--" + option->get_lnames().front());
    return fmt::format("unknown option '{}'.{}", extra,
                       suggestion(extra.substr(0, extra.find('=')), candidates));
  }
  if (!given.empty())
    return fmt::format("'{}' takes no further argument '{}'. See `penumbra {} --help`.",
                       given.front()->get_name(), extra, given.front()->get_name());
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
    candidates.push_back(sub->get_name());
  return fmt::format("unknown command '{}'.{}", extra, suggestion(extra, candidates));
}

void declare(CLI::App& app, Context& context) {
  app.set_version_flag("--version", "penumbra " PENUMBRA_VERSION);
  app.require_subcommand(0, 1);
  app.fallthrough();
  app.add_option("--device", context.device, "Vulkan device: part of its name, or its index");
  app.add_option("--threads", context.threads, "Threads of all host work, Embree and lavapipe (default: all)")
      ->check(CLI::Range(1, 4096));
  for (const auto& add : {add_run, add_render, add_list, add_describe, add_validate, add_metrics, add_export,
                          add_report, add_compare, add_baseline, add_merge, add_doctor, add_completion})
    add(app, context);
}

void use_threads(const Context& context) {
  if (context.threads == 0) return;
  set_threads(context.threads);
  // lavapipe reads its number of threads from the environment when the device is made.
  setenv("LP_NUM_THREADS", std::to_string(context.threads).c_str(), 1);
}

int run_program(int argc, char** argv) {
  Context context;
  context.registry = all_techniques();
  context.command_line.assign(argv, argv + argc);
  find_roots(context, argv[0]);
  CLI::App app("Penumbra measures shadow-rendering techniques against ray-traced ground truth.", "penumbra");
  declare(app, context);
  app.parse_complete_callback([&] { use_threads(context); });
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
  } catch (const CLI::ExtrasError&) {
    return message(exit_bad_input, unexpected_arguments(app));
  } catch (const CLI::ParseError& e) {
    const std::vector<CLI::App*> given = app.get_subcommands();
    return message(exit_bad_input, fmt::format("{}\nSee `penumbra {}--help`.", e.what(),
                                               given.empty() ? "" : given.front()->get_name() + " "));
  }
  if (app.get_subcommands().empty()) {
    std::cerr << app.help();
    return exit_bad_input;
  }
  return context.exit_code;
}

// A full disk or a closed pipe must not look like success.
int flush_output(int code) {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return message(exit_cannot_write, "standard output cannot be written.");
}

}  // namespace
}  // namespace penumbra

int main(int argc, char** argv) {
  using namespace penumbra;
  try {
    return flush_output(run_program(argc, argv));
  } catch (const InputError& e) {
    return message(exit_bad_input, e.what());
  } catch (const DeviceError& e) {
    return message(exit_no_device, e.what());
  } catch (const WriteError& e) {
    return message(exit_cannot_write, e.what());
  } catch (const PointError& e) {
    return message(exit_points_failed, e.what());
  } catch (const std::exception& e) {
    return message(exit_points_failed, std::string("internal error: ") + e.what());
  }
}
