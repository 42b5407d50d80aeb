#include "techniques/common/shadow_maps/moment_maps.h"

#include <array>
#include <bit>

#include "shaders/shadow_map_blur.h"
#include "shaders/shadow_map_halve_moments.h"
#include "shaders/shadow_map_moments.h"

namespace penumbra::shadow_map {

std::vector<gpu::Specialization> moment_constants(const Params& params) {
  return {{0, static_cast<uint32_t>(params.map_size)},
          {10, static_cast<uint32_t>(params.filter)},
          {11, params.moment_format == MomentFormat::bits16},
          {12, std::bit_cast<uint32_t>(params.evsm_positive)},
          {13, std::bit_cast<uint32_t>(params.evsm_negative)},
          {14, static_cast<uint32_t>(texels_of_layer(params))},
          {15, static_cast<uint32_t>(params.moment_levels())}};
}

uint64_t moment_bytes(const Params& params) {
  const uint64_t count = params.filter == Filter::vsm ? 2 : 4;
  return count * (params.moment_format == MomentFormat::bits16 ? 2 : 4);
}

uint64_t texels_of_layer(const Params& params) {
  uint64_t texels = 0;
  for (int level = 0; level < params.moment_levels(); ++level) {
    const auto size = static_cast<uint64_t>(std::max(params.map_size >> level, 1));
    texels += size * size;
  }
  return texels;
}

void MomentMaps::setup(gpu::Device& device) {
  const std::array images{gpu::ImageUse::sampled_nearest};
  std::vector<gpu::Specialization> constants = moment_constants(params_);
  make_ = gpu::ComputePipeline(device, shadow_map_moments_spv, sizeof(MomentsPush), constants, images);
  halve_ = gpu::ComputePipeline(device, shadow_map_halve_moments_spv, sizeof(MomentsPush), constants);
  constants.push_back({1, static_cast<uint32_t>(params_.filter_size)});
  constants.push_back({2, params_.blur == Blur::gaussian});
  constants.push_back({3, 0});
  across_ = gpu::ComputePipeline(device, shadow_map_blur_spv, sizeof(MomentsPush), constants);
  constants.back().value = 1;
  down_ = gpu::ComputePipeline(device, shadow_map_blur_spv, sizeof(MomentsPush), constants);
}

void MomentMaps::run(const Fitted& fitted, const DepthMaps& maps, gpu::PassRecorder& passes) {
  const uint64_t bytes = texels_of_layer(params_) * fitted.layers.size() * moment_bytes(params_);
  const bool blur = params_.filter_size > 1;
  gpu::ensure(moments_, passes.device(), bytes, gpu::Memory::device, "shadow map moments");
  if (blur) gpu::ensure(blurred_, passes.device(), bytes, gpu::Memory::device, "shadow map moments, blurred");
  const std::array views{maps.image().view()};
  make_.bind_images(views);
  const auto each_layer = [&](gpu::Commands& commands, const gpu::ComputePipeline& pipeline,
                              const gpu::Buffer& from, const gpu::Buffer& to, uint32_t level = 0) {
    const auto size = static_cast<uint64_t>(std::max(params_.map_size >> level, 1));
    for (uint32_t i = 0; i < fitted.layers.size(); ++i) {
      if (!fitted.layers[i].used) continue;
      const MomentsPush push{maps.layers().address(), from.address(), to.address(), i, level};
      commands.dispatch(pipeline, push, (size * size + 63) / 64);
    }
  };
  passes.device_pass("moments", [&](gpu::Commands& c) { each_layer(c, make_, moments_, moments_); });
  if (blur)
    passes.device_pass("blur", [&](gpu::Commands& c) {
      each_layer(c, across_, moments_, blurred_);
      c.barrier();
      each_layer(c, down_, blurred_, moments_);
    });
  if (params_.moment_levels() == 1) return;
  passes.device_pass("mips", [&](gpu::Commands& c) {
    for (uint32_t level = 1; level < static_cast<uint32_t>(params_.moment_levels()); ++level) {
      if (level > 1) c.barrier();
      each_layer(c, halve_, moments_, moments_, level);
    }
  });
}

}  // namespace penumbra::shadow_map
