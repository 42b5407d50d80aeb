#include "reference/shadow_segments.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numbers>

namespace penumbra {
namespace {

constexpr std::size_t packet = 16;
// Hits count for 0 < t < 1; Embree's upper end is inclusive.
constexpr float just_below_one = 0x1.fffffep-1F;

void leave_out_own_triangle(const RTCFilterFunctionNArguments* args) {
  const uint32_t own = *static_cast<const uint32_t*>(embree::Query::user_data(args));
  for (unsigned i = 0; i < args->N; ++i)
    if (RTCHitN_primID(args->hit, args->N, i) == own) args->valid[i] = 0;
}

}  // namespace

ShadowSegments::ShadowSegments(RTCScene scene, const Light& light, const LightSamples& samples,
                               ReferenceOrigin origin)
    : scene_(scene), light_(light), samples_(samples), origin_(origin) {
  if (light.kind == LightKind::spot)
    cone_cosine_ = static_cast<float>(std::cos(light.cone_degrees * std::numbers::pi / 180));
}

bool ShadowSegments::lights(Vec3f position, const Vec4f& light_point) const {
  if (light_.kind == LightKind::rectangle || light_.kind == LightKind::textured_rectangle)
    return dot(light_.direction, position - light_point.xyz()) > 0;
  if (light_.kind == LightKind::spot) {
    const Vec3f from_light = position - light_.center;
    return dot(light_.direction, from_light) >= cone_cosine_ * length(from_light);
  }
  return true;
}

bool ShadowSegments::blocked(const ReferenceViewSample& view, std::span<const Vec4f> points,
                             std::span<uint32_t> mask) const {
  std::ranges::fill(mask, 0U);
  bool any_above_horizon = false;
  const std::size_t count = points.size();
  for (std::size_t first = 0; first < count; first += packet) {
    const std::size_t lanes = std::min(packet, count - first);
    uint32_t wanted = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
      const Vec4f& l = points[first + i];
      const Vec3f to_light = l.w != 0 ? l.xyz() - view.position : l.xyz();
      const bool above = dot(view.geometric_normal, to_light) > 0;
      any_above_horizon = any_above_horizon || above;
      if (above && lights(view.position, l)) wanted |= 1U << i;
    }
    const uint32_t all = (1U << lanes) - 1;
    const uint32_t bits = (all & ~wanted) | (wanted ? trace(view, points, first, wanted) : 0);
    mask[first / 32] |= bits << (first % 32);
  }
  return any_above_horizon;
}

uint32_t ShadowSegments::trace(const ReferenceViewSample& view, std::span<const Vec4f> points,
                               std::size_t first, uint32_t wanted) const {
  alignas(64) RTCRay16 rays;
  alignas(64) int valid[packet];
  const Vec3f o = view.segment_origin;
  for (std::size_t i = 0; i < packet; ++i) {
    valid[i] = wanted >> i & 1 ? -1 : 0;
    const Vec4f& l = points[std::min(first + i, points.size() - 1)];
    const Vec3f along = l.w != 0 ? l.xyz() - o : l.xyz();
    rays.org_x[i] = o.x, rays.org_y[i] = o.y, rays.org_z[i] = o.z;
    rays.dir_x[i] = along.x, rays.dir_y[i] = along.y, rays.dir_z[i] = along.z;
    rays.tnear[i] = 0;
    rays.tfar[i] = l.w != 0 ? just_below_one : std::numeric_limits<float>::infinity();
    rays.time[i] = 0;
    rays.mask[i] = ~0U, rays.id[i] = 0, rays.flags[i] = 0;
  }
  uint32_t own = view.own_triangle;
  const bool exact = origin_ == ReferenceOrigin::exact;
  embree::Query query(embree::Coherence::incoherent, exact ? leave_out_own_triangle : nullptr,
                      exact ? &own : nullptr);
  query.occluded(valid, scene_, &rays);
  uint32_t hit = 0;
  for (std::size_t i = 0; i < packet; ++i)
    if (rays.tfar[i] < 0) hit |= 1U << i;
  return hit & wanted;
}

float ShadowSegments::visibility(std::span<const uint32_t> mask) const {
  if (samples_.uniform_weights) {
    int blocked_count = 0;
    for (const uint32_t word : mask) blocked_count += std::popcount(word);
    return static_cast<float>(samples_.count() - blocked_count) / static_cast<float>(samples_.count());
  }
  double sum = 0;
  for (std::size_t i = 0; i < samples_.points.size(); ++i)
    if ((mask[i / 32] >> (i % 32) & 1) == 0) sum += static_cast<double>(samples_.weights[i]);
  return static_cast<float>(std::min(sum, 1.0));
}

}  // namespace penumbra
