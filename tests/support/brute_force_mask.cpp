#include <numbers>

#include "core/parallel.h"
#include "tests/support/brute_force.h"

namespace penumbra::testing {
namespace {

// One rule of the horizon: a signed distance, blocked where it is not positive.
void apply(HorizonJudgement& h, double margin) {
  const bool blocks = !(margin > 0);
  // To clear a blocked bit every rule that blocks has to give way; to block a clear one, any rule.
  if (blocks != h.blocked)
    h = blocks ? HorizonJudgement{true, std::abs(margin)} : h;
  else
    h.distance = blocks ? std::max(h.distance, std::abs(margin)) : std::min(h.distance, std::abs(margin));
}

Vec4d light_point(const LightSamples& samples, int i, std::size_t pixel) {
  const Vec4f p = samples.at(static_cast<std::size_t>(i), samples.draw(pixel));
  return {p.x, p.y, p.z, p.w};
}

}  // namespace

HorizonJudgement judge_horizon(const Light& light, Vec3d position, Vec3d normal, Vec4d point) {
  HorizonJudgement h;
  const Vec3d n = normalize(normal),
              to_light = point.w != 0 ? point.xyz() - position : normalize(point.xyz());
  apply(h, dot(n, to_light));
  const Vec3d front = normalize(Vec3d(light.direction));
  if (light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle)
    apply(h, -dot(front, to_light));
  if (light.kind == LightKind::spot) {
    const Vec3d from_light = position - Vec3d(light.center);
    const double angle = std::atan2(length(cross(front, from_light)), dot(front, from_light));
    apply(h, (light.cone_degrees * std::numbers::pi / 180 - angle) * length(from_light));
  }
  return h;
}

Tie explain_bit(const BruteForce& scene, const Light& light, const LightSamples& samples,
                const ViewSamplesHost& view, std::size_t pixel, int light_sample, bool skip_own) {
  const Vec4d point = light_point(samples, light_sample, pixel);
  const Vec3d position(view.position[pixel].xyz()), normal(view.geometric_normal[pixel].xyz());
  const HorizonJudgement horizon = judge_horizon(light, position, normal, point);
  if (horizon.blocked && horizon.distance > scene.tie_tolerance()) return {true, horizon.distance};

  const Vec3d origin = skip_own ? position : Vec3d(view.origin[pixel].xyz());
  const Tie segment = scene.explain(origin, point, skip_own ? view.triangle[pixel] : no_triangle);
  if (horizon.blocked && segment.blocked) return {true, std::max(horizon.distance, segment.distance)};
  if (horizon.blocked) return {true, horizon.distance};
  if (segment.blocked) return segment;
  return {false, std::min(horizon.distance, segment.distance)};
}

std::vector<uint32_t> brute_force_mask(const BruteForce& scene, const Light& light,
                                       const LightSamples& samples, const ViewSamplesHost& view,
                                       bool skip_own) {
  const std::size_t words = static_cast<std::size_t>(samples.mask_words());
  std::vector<uint32_t> mask(view.pixel_count() * words, 0);
  parallel_for(view.pixel_count(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (view.triangle[pixel] == no_triangle) continue;
      const Vec3d position(view.position[pixel].xyz()), normal(view.geometric_normal[pixel].xyz());
      const Vec3d origin = skip_own ? position : Vec3d(view.origin[pixel].xyz());
      for (int i = 0; i < samples.count(); ++i) {
        const Vec4d point = light_point(samples, i, pixel);
        if (judge_horizon(light, position, normal, point).blocked ||
            scene.blocked(origin, point, skip_own ? view.triangle[pixel] : no_triangle))
          mask[pixel * words + static_cast<std::size_t>(i) / 32] |= 1U << (i % 32);
      }
    }
  });
  return mask;
}

Differences explain_differences(const BruteForce& scene, const Light& light, const LightSamples& samples,
                                const ViewSamplesHost& view, std::span<const uint32_t> mask,
                                std::span<const uint32_t> reference_mask, std::span<const uint8_t> evaluated,
                                bool skip_own) {
  Differences d;
  const std::size_t words = static_cast<std::size_t>(samples.mask_words());
  for (std::size_t pixel = 0; pixel < view.pixel_count(); ++pixel) {
    if (!evaluated.empty() && !evaluated[pixel]) continue;
    d.bits += static_cast<uint64_t>(samples.count());
    for (int i = 0; i < samples.count(); ++i) {
      const std::size_t word = pixel * words + static_cast<std::size_t>(i) / 32;
      if (((mask[word] ^ reference_mask[word]) >> (i % 32) & 1) == 0) continue;
      const Tie tie = explain_bit(scene, light, samples, view, pixel, i, skip_own);
      ++d.differing;
      if (!tie.within(scene.tie_tolerance())) ++d.unexplained;
      d.worst = std::max(d.worst, tie.distance / scene.tie_tolerance());
    }
  }
  return d;
}

}  // namespace penumbra::testing
