// What determines a point's result, as one hash: a resumed sweep keeps a point only if it is the same.
#pragma once
#include <string>

#include "config/plan.h"
#include "run/worker.h"

namespace penumbra::run {

// What a point is measured with, beside its parameters and the settings.
struct MeasuredWith {
  std::string scene_content;           // hash of what the scene's file says and its meshes hold
  std::string program, embree;         // versions
  std::string cpu;                     // model: of a software device all, and of what Embree does
  std::string device, driver_version;  // Vulkan
};

// 32 hexadecimal digits.
std::string fingerprint(const Point& point, const MeasuredWith& with, const WorkerSettings& settings);

}  // namespace penumbra::run
