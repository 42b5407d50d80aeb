// The worker: a process of its own that computes points for the supervisor. Jobs come in on standard input,
// events go out on worker_events_fd, both as JSON lines; where it is right now stands in the heartbeat.
//
// Jobs:    {"job":"start", ...WorkerSettings}, {"job":"batch", "points":[...], "done":{id: fingerprint}}; end
// of input. Events:  {"event":"hello", device...} | {"event":"no_device", message}
//          {"event":"scene", ...}, {"event":"view", scene, ...}   for run.json
//          {"event":"result", "record":{...}}, {"event":"skip", id}   one of them for each point
//          {"event":"costs", "costs":{...}}, {"event":"batch_done"}, {"event":"cannot_write", message}
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "config/plan.h"
#include "technique/technique.h"

namespace penumbra::run {

struct WorkerSettings {
  std::string device;  // --device
  int threads = 0;     // 0: all
  std::vector<std::filesystem::path> scene_search;
  std::filesystem::path run_folder, reference_cache;  // an empty run folder: no pictures, nothing is written
  std::vector<std::string> images;
  int reference_samples = 0;
  int frames = 1;
  MeasureSettings measure;
  int group_size = 8;  // points whose timed loops are interleaved
  double first_call_grace_s =
      30;  // set-up, build and first frame may take so much longer: they compile pipelines
};
nlohmann::json to_json(const WorkerSettings& settings);
WorkerSettings worker_settings_from_json(const nlohmann::json& json);

// Runs until standard input ends; the process's exit code. Never returns while a driver may still hold the
// process: call it as the last thing in main.
int worker_main(const Registry& registry);

// The folder of cached references: PENUMBRA_CACHE, else XDG_CACHE_HOME/penumbra, else ~/.cache/penumbra;
// empty if none.
std::filesystem::path default_cache_folder();

}  // namespace penumbra::run
