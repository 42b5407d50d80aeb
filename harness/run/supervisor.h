// The supervisor: hands points to a worker process, batch by batch, writes each result as it comes, and keeps
// what one point does from costing another: a crash, a hang, too much memory or a lost device ends the point
// that was active; the others go on in a new worker.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "config/plan.h"
#include "run/worker.h"
#include "technique/technique.h"

namespace penumbra::run {

struct RunOptions {
  std::filesystem::path out;
  bool resume = false, quiet = false;
  WorkerSettings worker;                    // run_folder, images, ... are filled in from the plan
  std::vector<std::string> worker_command;  // program and arguments that reach worker_main()
  std::vector<std::string> command_line;    // for run.json
  std::string shard;                        // "1/4", for run.json; the plan holds this shard's points only
  double limit_grace_s = 5;                 // past its limit by more than this, a worker is killed
  uint64_t memory_limit_bytes = 0;          // of a worker; 0: nine tenths of the machine's
};

struct RunOutcome {
  std::size_t ok = 0, unsupported = 0, failed = 0, timed_out = 0;
  std::size_t kept = 0;      // of those, finished by a former run
  bool interrupted = false;  // SIGINT or SIGTERM
  std::filesystem::path folder;
};

// Throws InputError (the folder holds results already, another run writes there, no points), DeviceError,
// WriteError. Whatever it throws after the first point, finished points are in the folder.
RunOutcome run_plan(const Plan& plan, const RunOptions& options, const Registry& registry);

}  // namespace penumbra::run
