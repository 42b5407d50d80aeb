#include "techniques/shadow_map/moment_maps.h"

#include <array>
#include <bit>

#include "shaders/shadow_map_blur.h"
#include "shaders/shadow_map_moments.h"

namespace penumbra::shadow_map {

std::vector<gpu::Specialization> moment_constants(const Params& params) {
  return {{10, static_cast<uint32_t>(params.filter)},
          {11, params.moment_format == MomentFormat::bits16},
          {12, std::bit_cast<uint32_t>(params.evsm_positive)},
          {13, std::bit_cast<uint32_t>(params.evsm_negative)}};
}

uint64_t moment_bytes(const Params& params) {
  const uint64_t count = params.filter == Filter::vsm ? 2 : 4;
  return count * (params.moment_format == MomentFormat::bits16 ? 2 : 4);
}

void MomentMaps::setup(gpu::Device& device) {
  const std::array images{gpu::ImageUse::sampled_nearest};
  std::vector<gpu::Specialization> constants = moment_constants(params_);
  constants.push_back({0, static_cast<uint32_t>(params_.map_size)});
  make_ = gpu::ComputePipeline(device, shadow_map_moments_spv, sizeof(MomentsPush), constants, images);
  constants.push_back({1, static_cast<uint32_t>(params_.filter_size)});
  constants.push_back({2, params_.blur == Blur::gaussian});
  constants.push_back({3, 0});
  across_ = gpu::ComputePipeline(device, shadow_map_blur_spv, sizeof(MomentsPush), constants);
  constants.back().value = 1;
  down_ = gpu::ComputePipeline(device, shadow_map_blur_spv, sizeof(MomentsPush), constants);
}

void MomentMaps::run(const Fitted& fitted, const DepthMaps& maps, gpu::PassRecorder& passes) {
  const auto size = static_cast<uint64_t>(params_.map_size);
  const uint64_t bytes = size * size * fitted.layers.size() * moment_bytes(params_);
  const bool blur = params_.filter_size > 1;
  gpu::ensure(moments_, passes.device(), bytes, gpu::Memory::device, "shadow map moments");
  if (blur) gpu::ensure(blurred_, passes.device(), bytes, gpu::Memory::device, "shadow map moments, blurred");
  const std::array views{maps.image().view()};
  make_.bind_images(views);
  const auto each_layer = [&](gpu::Commands& commands, const gpu::ComputePipeline& pipeline,
                              const gpu::Buffer& from, const gpu::Buffer& to) {
    for (uint32_t i = 0; i < fitted.layers.size(); ++i) {
      if (!fitted.layers[i].used) continue;
      const MomentsPush push{maps.layers().address(), from.address(), to.address(), i, 0};
      commands.dispatch(pipeline, push, (size * size + 63) / 64);
    }
  };
  passes.device_pass("moments", [&](gpu::Commands& c) { each_layer(c, make_, moments_, moments_); });
  if (!blur) return;
  passes.device_pass("blur", [&](gpu::Commands& c) {
    each_layer(c, across_, moments_, blurred_);
    c.barrier();
    each_layer(c, down_, blurred_, moments_);
  });
}

}  // namespace penumbra::shadow_map
