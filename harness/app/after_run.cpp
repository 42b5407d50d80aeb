#include "app/after_run.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "run/journal.h"
#include "run/table.h"

#if __has_include("report/report.h")
#include "report/report.h"
#define PENUMBRA_HAS_REPORT 1
#endif

extern char** environ;

namespace penumbra {
namespace {

namespace fs = std::filesystem;

// The script's exit code; its output goes to standard error, away from the table.
int run_script(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  for (const auto& a : command) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, 2, 1);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return 127;
  int status = 0;
  ::waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int make_plots(const fs::path& folder, const Context& context) {
  fs::path script;
  try {
    script = context.find_file("scripts/plot");
  } catch (const InputError&) {
    return exit_done;  // a program installed without its scripts
  }
  const int code = run_script({script.string(), folder.string()});
  if (code != 0)
    fmt::print(stderr, "penumbra: the plots were not made: {} ended with exit code {}.\n", script.string(),
               code);
  return code == exit_cannot_write ? exit_cannot_write : exit_done;
}

void make_report([[maybe_unused]] const fs::path& folder) {
#ifdef PENUMBRA_HAS_REPORT
  const ReportSummary summary = write_report(folder, {});
  for (const std::string& warning : summary.warnings) fmt::print(stderr, "penumbra: {}\n", warning);
  fmt::print("report: {}\n", summary.index.string());
#endif
}

}  // namespace

int after_run(const fs::path& folder, const Context& context, bool complete) {
  fmt::print("{}", run::table([&](const auto& visit) { run::for_each_point(folder, visit); }));
  fmt::print("results: {}\n", (folder / "results.json").string());
  if (!complete) return exit_done;
  int code = make_plots(folder, context);
  try {
    make_report(folder);
  } catch (const WriteError& e) {
    fmt::print(stderr, "penumbra: the report was not made: {}\n", e.what());
    code = exit_cannot_write;
  } catch (const std::exception& e) {
    fmt::print(stderr, "penumbra: the report was not made: {}\n", e.what());
  }
  return code;
}

}  // namespace penumbra
