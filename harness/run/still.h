// One point, once, in this process: for looking at, not for measuring.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "config/plan.h"
#include "core/vec.h"
#include "gpu/pass_recorder.h"

namespace penumbra::run {

struct Still {
  std::string unsupported;  // the reason, and no picture then
  int width = 0, height = 0;
  std::vector<float> visibility;      // 1 where not evaluated
  std::vector<Vec3f> shaded;          // as shade() of judge.h makes it
  std::vector<gpu::PassTime> passes;  // of a second frame: what the first one compiles is not in it
};

// Throws InputError, DeviceError, PointError.
Still render_still(const Point& point, const Registry& registry,
                   const std::vector<std::filesystem::path>& scene_search, const std::string& device);

}  // namespace penumbra::run
