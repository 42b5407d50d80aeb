// What the points of one view (scene, camera, resolution, frame) share in a worker: geometry on the device,
// view samples, light samples and references, each made once and only when first needed.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "config/plan.h"
#include "gpu/pass_recorder.h"
#include "reference/reference.h"
#include "run/flicker.h"
#include "run/heartbeat.h"
#include "samples/view_samples.h"
#include "scene/scene.h"

namespace penumbra::run {

// A frame under one light. `previous` exists for later frames of a moving scene: techniques are built on it
// first, so that what is measured is the step from one frame to the next.
struct LitFrame {
  Frame current;
  std::unique_ptr<Frame> previous;
  Changes step;     // from previous to current; all false where nothing moves
  std::string key;  // names light and size
};

// Seconds that the harness spent on each kind of work; the parts that are not the techniques' own.
using Costs = std::map<std::string, double>;

class View {
 public:
  // Throws PointError when the device cannot hold it. `like`: any point of the view.
  View(const Scene& scene, const Point& like, gpu::PassRecorder& passes, Costs& costs);
  ~View();

  std::shared_ptr<LitFrame> lit_frame(const Point& point);
  // The device's geometry holds this frame (previous or current) afterwards. Leaves frame.changes as they
  // were.
  void show(Frame& frame);
  const GeometryOnDevice& geometry() const { return geometry_; }
  const ViewSamples& samples() const { return *samples_; }

  // `set`: of the jitter's, below the point's `accumulate`.
  const LightSamples& light_samples(const LitFrame& lit, const Point& point, int set = 0);
  const MatchedReference& matched(const LitFrame& lit, const Point& point, ReferenceOrigin origin,
                                  int set = 0);
  const ReferenceScene::Converged& converged(const LitFrame& lit, const Point& point, ReferenceOrigin origin,
                                             int n, const std::filesystem::path& cache,
                                             SphereAs sphere = SphereAs::ball);
  // Where each pixel was a frame before: made once for all techniques.
  const std::vector<PastPixels>& past(LitFrame& lit);
  // For run.json: camera, resolution, frame, triangles, view_samples_ms and its passes, upload_ms.
  const nlohmann::json& report() const { return *report_; }

 private:
  void make_samples(Frame& frame);
  ReferenceScene& reference();
  const Scene& scene_;
  gpu::PassRecorder& passes_;
  Costs& costs_;
  GeometryOnDevice geometry_;
  std::unique_ptr<ViewSamples> samples_;
  std::unique_ptr<ReferenceScene> reference_;
  std::shared_ptr<LitFrame> first_;  // the reference's structure reads its geometry
  std::map<std::string, std::weak_ptr<LitFrame>> frames_;
  std::vector<PastPixels> past_;
  std::map<std::string, LightSamples> light_samples_;
  std::map<std::string, MatchedReference> matched_;
  std::map<std::string, ReferenceScene::Converged> converged_;
  std::unique_ptr<nlohmann::json> report_;
  int shown_ = -1;  // index of the frame that geometry_ holds
};

// Adds the seconds from its birth to its death to one entry of the costs.
class CostTimer {
 public:
  CostTimer(Costs& costs, const char* entry);
  ~CostTimer();
  CostTimer(const CostTimer&) = delete;
  CostTimer& operator=(const CostTimer&) = delete;

 private:
  Costs& costs_;
  const char* entry_;
  double start_;
};

// Seconds of the monotonic clock.
double now_s();

}  // namespace penumbra::run
