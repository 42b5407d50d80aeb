#include "run/fingerprint.h"

#include "core/hash.h"

namespace penumbra::run {

std::string fingerprint(const Point& point, const MeasuredWith& with, const WorkerSettings& settings) {
  const MeasureSettings& m = settings.measure;
  Hasher hash;
  // The id is the hash of technique, scene, frame and all parameters, axes included.
  hash.text(point.id).text(with.scene_content).text(with.program).text(with.embree).text(with.cpu);
  hash.text(with.device).text(with.driver_version).value(settings.reference_samples).value(settings.threads);
  hash.value(settings.frames).value(m.warmup).value(m.repetitions).value(m.min_time_s).value(m.max_time_s);
  hash.value(m.target_interval);
  if (!m.counters) hash.value(m.counters);
  for (const std::string& image : settings.images) hash.text(image);
  return hash.hex();
}

}  // namespace penumbra::run
