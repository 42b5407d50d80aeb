#include "techniques/common/shadow_maps/lookup.h"

#include <array>
#include <bit>

#include "shaders/shadow_map_lookup.h"
#include "shaders/shadow_map_lookup_moments.h"

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

void Lookup::setup(gpu::Device& device, bool round_light, gpu::PassRecorder& passes) {
  if (params_.filterable()) {
    std::vector<gpu::Specialization> constants = moment_constants(params_);
    constants.push_back({1, 0});
    frustum_ = gpu::ComputePipeline(device, shadow_map_lookup_moments_spv, sizeof(LookupPush), constants);
    constants.back().value = 1;
    faces_ = gpu::ComputePipeline(device, shadow_map_lookup_moments_spv, sizeof(LookupPush), constants);
    if (params_.moment_levels() > 1)
      camera_ = gpu::Buffer(device, 3 * sizeof(Vec4f), gpu::Memory::upload, "shadow map camera");
    return;
  }
  const bool disc = params_.pcf_pattern == PcfPattern::poisson, soft = params_.filter == Filter::pcss;
  const auto size = static_cast<uint32_t>(params_.map_size);
  const std::array images{gpu::ImageUse::sampled_nearest};
  const auto make = [&](bool faces) {
    const std::array<gpu::Specialization, 9> constants{
        {{0, size},
         {1, faces},
         {2, static_cast<uint32_t>(params_.pcf_kernel)},
         {3, static_cast<uint32_t>(disc ? params_.poisson_samples : 0)},
         {4, params_.poisson_rotation},
         {5, params_.receiver_plane_bias},
         {6, static_cast<uint32_t>(soft ? params_.pcss_search : 0)},
         {7, round_light},
         {8, std::bit_cast<uint32_t>(static_cast<float>(params_.border_texels() - 1))}}};
    return gpu::ComputePipeline(device, shadow_map_lookup_spv, sizeof(LookupPush), constants, images);
  };
  frustum_ = make(false), faces_ = make(true);
  const std::vector<Vec2f> points = disc_points(params_.poisson_samples);
  disc_ = gpu::Buffer(device, points.size() * sizeof(Vec2f), gpu::Memory::device, "Poisson disc");
  gpu::upload(passes, "upload_disc", disc_, points.data(), points.size() * sizeof(Vec2f));
}

// Where pixels are, for footprint() of layer.glsl.
void Lookup::tell_camera(const Case& c) {
  const Camera& camera = c.frame->camera;
  const auto step = [&](double x, double y) {
    const Vec3d d =
        camera.ray_direction(x, y, c.width, c.height) - camera.ray_direction(0, 0, c.width, c.height);
    return Vec4f{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z), 0};
  };
  const std::span<Vec4f> out = camera_.view<Vec4f>();
  out[0] = {camera.eye.x, camera.eye.y, camera.eye.z, 1};
  out[1] = step(1, 0), out[2] = step(0, 1);
}

void Lookup::run(const RenderInput& in, const Fitted& fitted, const DepthMaps& maps,
                 const MomentMaps& moments, gpu::PassRecorder& passes) {
  const ViewSamples& samples = *in.view_samples;
  const auto count = static_cast<uint32_t>(samples.width() * samples.height());
  gpu::ComputePipeline& pipeline = fitted.six_faces ? faces_ : frustum_;
  if (!params_.filterable()) {
    const std::array views{maps.image().view()};
    pipeline.bind_images(views);
  }
  LookupPush push{};
  push.light = fitted.light.device_towards(), push.emission = fitted.light.device_emission();
  push.position = samples.position().address(), push.origin = samples.origin().address();
  push.normal = samples.geometric_normal().address();
  push.layers = maps.layers().address(), push.disc = disc_.address(),
  push.moments = moments.moments().address();
  push.visibility = in.device.visibility->address();
  if (camera_) tell_camera(*in.scene_case), push.camera = camera_.address();
  push.max_probes = params_.moment_filtering == MomentFiltering::anisotropic
                        ? static_cast<uint32_t>(params_.max_anisotropy)
                        : 1;
  push.count = count, push.layer_count = static_cast<uint32_t>(fitted.layers.size());
  push.constant_bias = params_.constant_bias * in.scene_case->frame->geometry.bounds.diagonal();
  push.bleeding_reduction = params_.bleeding_reduction;
  push.variance_or_bias = params_.filter == Filter::msm ? params_.moment_bias : params_.min_variance;
  passes.device_pass("lookup",
                     [&](gpu::Commands& commands) { commands.dispatch(pipeline, push, (count + 63) / 64); });
}

}  // namespace penumbra::shadow_map
