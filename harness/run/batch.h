// The points of one view, one after the other: prepared and judged alone, timed in small groups whose loops
// are interleaved, sent as they finish.
#pragma once
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "run/measure.h"
#include "run/pictures.h"
#include "run/record.h"
#include "run/worker.h"

namespace penumbra::run {

class BatchRunner {
 public:
  using Send = std::function<void(const nlohmann::json&)>;
  BatchRunner(const Registry& registry, const WorkerSettings& settings, gpu::Device& device,
              Heartbeat& heartbeat, Costs& costs, Send send);

  // All points are of one view. `done`: id -> fingerprint of points that a former run has finished; they are
  // skipped when nothing that determines them has changed. False when the device answers no more: the process
  // is to be replaced. Throws WriteError; everything else that goes wrong is a point's result.
  bool run(const std::vector<Point>& points, const nlohmann::json& done);

 private:
  struct Prepared {
    std::unique_ptr<PointRun> run;
    nlohmann::json record;
  };
  // What went wrong, or nothing.
  std::string open_view(const Point& like);
  std::string fingerprint(const Point& point) const;
  // Empty when the point is finished already (unsupported or failed, and sent).
  std::optional<Prepared> prepare(const Point& point);
  std::optional<Prepared> try_prepare(const Point& point);
  void judge(Prepared& prepared);
  void judge_own_truth(Prepared& prepared, std::span<const uint8_t> evaluated);
  void add_flicker(nlohmann::json& metrics, PointRun& run, std::span<const float> error);
  void finish_group();
  void fail(const Point& point, const std::string& message, const Heartbeat::State& at);
  bool memory_is_short() const;
  bool device_answers();

  const Registry& registry_;
  const WorkerSettings& settings_;
  gpu::Device& device_;
  Heartbeat& heartbeat_;
  Costs& costs_;
  Send send_;
  gpu::PassRecorder passes_;
  Pictures pictures_;
  OutputBuffers outputs_;
  std::string scene_name_, view_key_;
  std::optional<Scene> scene_;
  std::unique_ptr<View> view_;
  std::vector<Prepared> group_;
  bool healthy_ = true;
};

}  // namespace penumbra::run
