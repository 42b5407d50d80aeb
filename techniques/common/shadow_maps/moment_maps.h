// Filterable maps: moments of depth per texel, blurred, with a mip chain where it is asked for. Buffers, not
// images: every device blurs and interpolates floats there, and the layout is the same for all formats.
#pragma once
#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "techniques/common/shadow_maps/depth_maps.h"

namespace penumbra::shadow_map {

// Constants of shaders/moments.glsl.
std::vector<gpu::Specialization> moment_constants(const Params& params);
// Bytes of one texel's moments.
uint64_t moment_bytes(const Params& params);
// Texels of one layer with all its levels, which lie one behind the other, the finest first.
uint64_t texels_of_layer(const Params& params);

class MomentMaps {
 public:
  explicit MomentMaps(const Params& params) : params_(params) {}
  void setup(gpu::Device& device);
  // Passes "moments", "blur", "mips". Allocates as DepthMaps does.
  void run(const Fitted& fitted, const DepthMaps& maps, gpu::PassRecorder& passes);
  const gpu::Buffer& moments() const { return moments_; }
  uint64_t bytes() const { return moments_.bytes() + blurred_.bytes(); }

 private:
  Params params_;
  gpu::ComputePipeline make_, across_, down_, halve_;
  gpu::Buffer moments_, blurred_;
};

}  // namespace penumbra::shadow_map
