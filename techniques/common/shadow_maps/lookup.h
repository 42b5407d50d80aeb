// From depth maps to visibility.
#pragma once
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/common/shadow_maps/depth_maps.h"
#include "techniques/common/shadow_maps/moment_maps.h"

namespace penumbra::shadow_map {

// `count` points spread over the unit disc by best candidates: the same on every platform.
std::vector<Vec2f> disc_points(int count);

class Lookup {
 public:
  explicit Lookup(const Params& params) : params_(params) {}
  void setup(gpu::Device& device, bool round_light, gpu::PassRecorder& passes);
  // Pass "lookup".
  void run(const RenderInput& in, const Fitted& fitted, const DepthMaps& maps, const MomentMaps& moments,
           gpu::PassRecorder& passes);
  uint64_t bytes() const { return disc_.bytes() + camera_.bytes(); }

 private:
  void tell_camera(const Case& c);
  Params params_;
  gpu::ComputePipeline frustum_, faces_;
  gpu::Buffer disc_, camera_;
};

}  // namespace penumbra::shadow_map
