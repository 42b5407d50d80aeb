#include "run/still.h"

#include "run/judge.h"
#include "run/point_run.h"

namespace penumbra::run {

Still render_still(const Point& point, const Registry& registry,
                   const std::vector<std::filesystem::path>& scene_search, const std::string& device_name) {
  const Scene scene = Scene::load(point.scene, scene_search);
  gpu::Device device(gpu::DeviceOptions{device_name, false});
  gpu::PassRecorder passes(device);
  Costs costs;
  Heartbeat heartbeat;
  View view(scene, point, passes, costs);
  OutputBuffers outputs;
  PointRun run(point, find_technique(registry, point.technique), view, outputs, passes, heartbeat, costs,
               TimeLimits{});
  Still still;
  still.width = point.width;
  still.height = point.height;
  std::optional<std::string> reason = run.unsupported();
  try {
    if (!reason) run.prepare();
  } catch (const UnsupportedError& e) {
    reason = e.what();
  }
  if (reason) {
    still.unsupported = *reason;
    return still;
  }
  Accumulation frames;
  for (int set = 0; set < point.accumulate; ++set) {
    if (set > 0) run.take_set(set);
    frames.add(run.output(), view.matched(run.lit(), point, run.origin(), set), run.light_samples(),
               point.width);
  }
  frames.take_mean(run.output());
  still.visibility = run.output().visibility;
  still.shaded = shade(view.samples().host(), run.lit().current, still.visibility, run.output().cosines);
  const FrameTimes times = run.frame();
  still.passes = times.build;
  still.passes.insert(still.passes.end(), times.render.begin(), times.render.end());
  return still;
}

}  // namespace penumbra::run
