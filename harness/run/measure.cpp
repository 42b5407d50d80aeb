#include "run/measure.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

namespace penumbra::run {
namespace {

// Google Benchmark wants to report; the samples are kept here instead.
class SilentReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

void initialize_once() {
  static const bool done = [] {
    char program[] = "penumbra", interleave[] = "--benchmark_enable_random_interleaving=true";
    char* arguments[] = {program, interleave, nullptr};
    int count = 2;
    benchmark::Initialize(&count, arguments);
    return true;
  }();
  (void)done;
}

class Measurement {
 public:
  Measurement(PointRun& run, const MeasureSettings& settings, Heartbeat& heartbeat)
      : settings_(settings), heartbeat_(heartbeat) {
    result.run = &run;
  }

  void warm_up() {
    guarded([&] {
      heartbeat_.stage("warm-up");
      repeat_builds();
      // The first frame, which was judged, warmed up too. Short frames are tried once more: the first one's
      // cost says little about the number that fills min_time_s.
      double last_s = result.run->first_frame_ms * 1e-3;
      for (int i = 1; i < settings_.warmup || (i == 1 && last_s < 0.25); ++i) last_s = frame_s();
      estimate_s_ = std::max(last_s, 1e-7);
    });
  }

  bool satisfied() const {
    return !result.error.empty() || out_of_time() ||
           (result.frame_ms.size() >= static_cast<std::size_t>(settings_.repetitions) &&
            spent_s_ >= settings_.min_time_s && (settings_.target_interval <= 0 || target_reached()));
  }

  // Registers what is still wanted: `repetitions` rounds, each long enough that together they fill
  // min_time_s.
  void register_round() {
    const double wanted_s = std::max(settings_.min_time_s - spent_s_, 0.0);
    const auto room = static_cast<int>(std::min((settings_.max_time_s - spent_s_) / estimate_s_, 1e6));
    // An interval narrows with the root of the number of samples: half as many again, and look anew.
    const auto more = static_cast<int>(result.frame_ms.size() / 2 + 1);
    const bool enough = result.frame_ms.size() >= static_cast<std::size_t>(settings_.repetitions);
    const int repetitions = std::clamp(enough ? more : settings_.repetitions, 1, std::max(room, 1));
    const double per_repetition = std::ceil(wanted_s / repetitions / estimate_s_);
    const auto iterations = static_cast<benchmark::IterationCount>(std::clamp(per_repetition, 1.0, 1e6));
    benchmark::RegisterBenchmark(result.run->point().id.c_str(),
                                 [this](benchmark::State& s) { repetition(s); })
        ->UseManualTime()
        ->Repetitions(repetitions)
        ->Iterations(iterations);
  }

  void finish() {
    heartbeat_.limit(0);
    if (!result.error.empty()) return;
    const bool enough = result.frame_ms.size() >= static_cast<std::size_t>(settings_.repetitions);
    result.interval = interval();
    const bool wide = settings_.target_interval > 0 && result.interval > settings_.target_interval;
    if (out_of_time() && (!enough || spent_s_ < settings_.min_time_s || wide))
      result.stopped_by = "max_time_s";
    else if (settings_.target_interval > 0)
      result.stopped_by = "target_interval";
    else if (result.frame_ms.size() > static_cast<std::size_t>(settings_.repetitions))
      result.stopped_by = "min_time_s";
  }

  Measured result;

 private:
  bool out_of_time() const { return !result.frame_ms.empty() && spent_s_ >= settings_.max_time_s; }

  // How far the median's 95 % interval reaches to its farther side, as a share of the median.
  double interval() const {
    std::vector<double> ascending = result.frame_ms;
    std::ranges::sort(ascending);
    const double median = quantile(ascending, 0.5);
    const auto [lo, hi] = median_interval(ascending);
    return median > 0 ? std::max(hi - median, median - lo) / median : 0;
  }

  // Fewer than six samples have their extremes as interval: that says nothing when they happen to agree.
  bool target_reached() const {
    return result.frame_ms.size() >= 6 && interval() <= settings_.target_interval;
  }

  // No exception may pass through Google Benchmark.
  template <class Work>
  void guarded(Work&& work) {
    try {
      heartbeat_.enter_point(result.run->point().id);
      work();
    } catch (const std::exception& e) {
      result.error = e.what();
      result.failed_at = heartbeat_.read();
      result.run->abandon();
    }
    heartbeat_.leave_point();
  }

  double frame_s() {
    heartbeat_.limit(settings_.max_time_s);
    return result.run->frame().frame_ms() * 1e-3;
  }

  void repeat_builds() {
    if (result.run->dynamic() || result.run->lit().previous) return;
    const double start = now_s();
    while (static_cast<int>(result.run->build_ms.size()) < settings_.repetitions &&
           now_s() - start < settings_.min_time_s)
      result.run->rebuild();
  }

  // Google Benchmark insists on the same number of iterations in all repetitions: when the point has failed
  // or its time is over, what is left of them is empty.
  void repetition(benchmark::State& state) {
    for (auto _ : state) {
      double frame_s = 0;
      if (result.error.empty() && !out_of_time())
        guarded([&] {
          heartbeat_.stage("measure");
          frame_s = timed_frame().frame_ms() * 1e-3;
        });
      state.SetIterationTime(frame_s);
    }
    // Before the next point writes into the same buffers.
    if (satisfied() && result.error.empty() && !checked_)
      guarded([&] {
        checked_ = true;
        result.repeatable = result.run->repeats_first_frame();
      });
  }

  FrameTimes timed_frame() {
    heartbeat_.limit(settings_.max_time_s);
    FrameTimes times = result.run->frame();
    result.frame_ms.push_back(times.frame_ms());
    result.wall_ms.push_back(times.wall_ms);
    result.cpu_ms.push_back(times.cpu_ms);
    if (result.run->dynamic()) result.build_ms.push_back(times.build_ms());
    for (const auto* part : {&times.build, &times.render})
      for (const gpu::PassTime& pass : *part) result.passes[pass.name].push_back(pass.ms);
    spent_s_ += times.wall_ms * 1e-3;
    return times;
  }

  const MeasureSettings& settings_;
  Heartbeat& heartbeat_;
  double estimate_s_ = 1e-3, spent_s_ = 0;
  bool checked_ = false;  // whether the output repeats
};

}  // namespace

std::vector<Measured> measure(const std::vector<PointRun*>& runs, const MeasureSettings& settings,
                              Heartbeat& heartbeat) {
  initialize_once();
  std::vector<std::unique_ptr<Measurement>> all;
  for (PointRun* run : runs) all.push_back(std::make_unique<Measurement>(*run, settings, heartbeat));
  for (auto& m : all) m->warm_up();
  // One round is enough unless the warm-up frame was much dearer than the others.
  for (;;) {
    benchmark::ClearRegisteredBenchmarks();
    std::size_t registered = 0;
    for (auto& m : all)
      if (!m->satisfied()) m->register_round(), ++registered;
    if (registered == 0) break;
    SilentReporter silent;
    benchmark::RunSpecifiedBenchmarks(&silent, ".");
  }
  std::vector<Measured> results;
  for (auto& m : all) {
    m->finish();
    results.push_back(std::move(m->result));
  }
  return results;
}

nlohmann::json timing_json(const Measured& m) {
  const SampleQuality quality = judge_samples(m.frame_ms);
  nlohmann::json passes = nlohmann::json::object();
  for (const auto& [name, samples] : m.passes) passes[name] = to_json(summarize(samples));
  nlohmann::json build_passes = nlohmann::json::object();
  for (const gpu::PassTime& pass : m.run->build_passes) build_passes[pass.name] = pass.ms;
  const auto& builds = m.run->dynamic() ? m.build_ms : m.run->build_ms;
  return {{"frame_ms", to_json(summarize(m.frame_ms))},
          {"build_ms", to_json(summarize(builds))},
          {"setup_ms", to_json(summarize({m.run->setup_ms}))},
          {"wall_ms", to_json(summarize(m.wall_ms))},
          {"cpu_ms", to_json(summarize(m.cpu_ms))},
          {"first_frame_ms", m.run->first_frame_ms},
          {"passes", passes},
          {"build_passes", build_passes},
          {"dynamic", m.run->dynamic()},
          {"stopped_by", m.stopped_by},
          {"interval", m.interval},
          {"outliers", quality.outliers},
          {"drift", quality.drift},
          {"drifts", quality.drifts},
          {"repeatable", m.repeatable}};
}

}  // namespace penumbra::run
