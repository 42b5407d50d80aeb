// The timed loops, driven by Google Benchmark: repetitions of several points in random order, so that what
// drifts (heat, load, clock) meets all of them alike. Time is the sum of the pass timers, handed over as
// manual time.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "config/plan.h"
#include "run/point_run.h"
#include "run/statistics.h"

namespace penumbra::run {

struct Measured {
  PointRun* run = nullptr;
  std::vector<double> frame_ms, build_ms, wall_ms,
      cpu_ms;  // one per timed frame; build_ms of dynamic points only
  std::map<std::string, std::vector<double>> passes;
  std::string error;  // why measuring broke off; the point failed
  Heartbeat::State failed_at;
  bool repeatable = true;                  // the last frame's output equals the first's, bit for bit
  const char* stopped_by = "repetitions";  // or "min_time_s", "max_time_s", "target_interval"
  double interval =
      0;  // reach of the frame time's 95 % interval to its farther side, as a share of the median
};

// Warm-up, then frames until there are `repetitions` of them and min_time_s is filled, or max_time_s is over
// (at least one). With a target_interval, also until the median's interval is that narrow. `runs` are
// prepared and sealed. Also repeats the build of points that are not dynamic, within min_time_s.
std::vector<Measured> measure(const std::vector<PointRun*>& runs, const MeasureSettings& settings,
                              Heartbeat& heartbeat);

// "timing" of contract.md.
nlohmann::json timing_json(const Measured& measured);

}  // namespace penumbra::run
