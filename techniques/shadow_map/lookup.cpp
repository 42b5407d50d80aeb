#include "techniques/shadow_map/lookup.h"

#include <array>

#include "shaders/shadow_map_lookup.h"

namespace penumbra::shadow_map {

std::vector<Vec2f> disc_points(int count) {
  uint32_t state = 0x2545f491U;
  const auto random = [&] {  // xorshift, in [-1, 1]
    state ^= state << 13, state ^= state >> 17, state ^= state << 5;
    return static_cast<float>(state >> 8) / 8388607.5f - 1;
  };
  std::vector<Vec2f> points;
  while (static_cast<int>(points.size()) < count) {
    Vec2f best{};
    float best_distance = -1;
    for (std::size_t candidate = 0; candidate < 16 * (points.size() + 1);) {
      const Vec2f p{random(), random()};
      if (p.x * p.x + p.y * p.y > 1) continue;
      ++candidate;
      float nearest = 8;
      for (const Vec2f& q : points)
        nearest = std::min(nearest, (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
      if (nearest > best_distance) best = p, best_distance = nearest;
    }
    points.push_back(best);
  }
  return points;
}

void Lookup::setup(gpu::Device& device, gpu::PassRecorder& passes) {
  const bool disc = params_.pcf_pattern == PcfPattern::poisson;
  const std::array images{gpu::ImageUse::sampled_nearest};
  const auto make = [&](bool faces) {
    const std::array<gpu::Specialization, 6> constants{
        {{0, static_cast<uint32_t>(params_.map_size)},
         {1, faces},
         {2, static_cast<uint32_t>(params_.pcf_kernel)},
         {3, static_cast<uint32_t>(disc ? params_.poisson_samples : 0)},
         {4, params_.poisson_rotation},
         {5, params_.receiver_plane_bias}}};
    return gpu::ComputePipeline(device, shadow_map_lookup_spv, sizeof(LookupPush), constants, images);
  };
  frustum_ = make(false), faces_ = make(true);
  const std::vector<Vec2f> points = disc_points(params_.poisson_samples);
  disc_ = gpu::Buffer(device, points.size() * sizeof(Vec2f), gpu::Memory::device, "Poisson disc");
  gpu::upload(passes, "upload_disc", disc_, points.data(), points.size() * sizeof(Vec2f));
}

void Lookup::run(const RenderInput& in, const Fitted& fitted, const DepthMaps& maps,
                 gpu::PassRecorder& passes) {
  const ViewSamples& samples = *in.view_samples;
  const auto count = static_cast<uint32_t>(samples.width() * samples.height());
  gpu::ComputePipeline& pipeline = fitted.six_faces ? faces_ : frustum_;
  const std::array views{maps.image().view()};
  pipeline.bind_images(views);
  const LookupPush push{fitted.light.device_towards(),
                        fitted.light.device_emission(),
                        samples.position().address(),
                        samples.origin().address(),
                        samples.geometric_normal().address(),
                        maps.layers().address(),
                        disc_.address(),
                        in.device.visibility->address(),
                        count,
                        static_cast<uint32_t>(fitted.layers.size()),
                        params_.constant_bias * in.scene_case->frame->geometry.bounds.diagonal(),
                        0};
  passes.device_pass("lookup",
                     [&](gpu::Commands& commands) { commands.dispatch(pipeline, push, (count + 63) / 64); });
}

}  // namespace penumbra::shadow_map
