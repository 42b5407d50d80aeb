// The program's subcommands: one file each, one function each. add_x() declares the subcommand and its
// options; its callback does the work when the whole command line has been accepted, and throws on error
// (main turns exceptions into messages and exit codes: InputError 2, DeviceError 3, WriteError 4).
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "technique/technique.h"

namespace penumbra {

enum ExitCode : int {
  exit_done = 0,
  exit_points_failed = 1,  // done, but points failed or timed out, or a comparison found something
  exit_bad_input = 2,      // nothing was run
  exit_no_device = 3,
  exit_cannot_write = 4,
  exit_interrupted = 130,  // everything finished so far is kept
};

// What all subcommands share.
struct Context {
  Registry registry;
  std::string device;  // --device: name or index, "" = PENUMBRA_DEVICE or the first
  int threads = 0;     // --threads; 0 = all. main has called set_threads() already.
  std::vector<std::filesystem::path>
      roots;  // folders that have configs/: cwd, the source tree, beside the program
  std::vector<std::filesystem::path> scene_search;  // their configs/scenes/
  std::vector<std::string> command_line;            // as typed, argv[0] first
  int exit_code = exit_done;                        // set by the callback

  // A config by path, or by name under a root ("quick", "papers/gears/table2", "configs/quick.json").
  // Throws InputError with the nearest name.
  std::filesystem::path find_config(const std::string& name) const;
  // A file of the source tree ("scripts/plot"); throws InputError when no root has it.
  std::filesystem::path find_file(const std::string& relative) const;
  // Names of all configs, without .json, relative to configs/; schema/ and scenes/ are left out.
  std::vector<std::string> config_names() const;
  std::vector<std::string> scene_names() const;
};

// Fills roots and scene_search.
void find_roots(Context& context, const char* argv0);

void add_run(CLI::App& app, Context& context);  // run, and the hidden worker
void add_render(CLI::App& app, Context& context);
void add_list(CLI::App& app, Context& context);
void add_describe(CLI::App& app, Context& context);
void add_validate(CLI::App& app, Context& context);
void add_metrics(CLI::App& app, Context& context);
void add_export(CLI::App& app, Context& context);
void add_report(CLI::App& app, Context& context);
void add_compare(CLI::App& app, Context& context);
void add_baseline(CLI::App& app, Context& context);
void add_merge(CLI::App& app, Context& context);
void add_completion(CLI::App& app, Context& context);
void add_doctor(CLI::App& app, Context& context);

}  // namespace penumbra
