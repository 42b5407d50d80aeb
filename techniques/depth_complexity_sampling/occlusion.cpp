#include "techniques/depth_complexity_sampling/occlusion.h"

#include <cstring>

namespace penumbra::depth_complexity {
namespace {

// Hits count for 0 < t < 1, and Embree's upper end is inclusive.
constexpr float just_below_one = 0x1.fffffep-1F;

template <int N>
struct Rays;
template <>
struct Rays<4> {
  using type = RTCRay4;
};
template <>
struct Rays<8> {
  using type = RTCRay8;
};
template <>
struct Rays<16> {
  using type = RTCRay16;
};

template <int N>
uint32_t trace(RTCScene scene, const Segments& s, std::size_t first, uint32_t wanted) {
  alignas(64) typename Rays<N>::type rays;
  alignas(64) int valid[N];
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t j = first + i;
    rays.org_x[i] = s.x[j], rays.org_y[i] = s.y[j], rays.org_z[i] = s.z[j];
    rays.dir_x[i] = s.to_x[j] - s.x[j], rays.dir_y[i] = s.to_y[j] - s.y[j],
    rays.dir_z[i] = s.to_z[j] - s.z[j];
    rays.tnear[i] = 0, rays.tfar[i] = just_below_one, rays.time[i] = 0;
    rays.mask[i] = ~0U, rays.id[i] = rays.flags[i] = 0;
    valid[i] = wanted >> j & 1 ? -1 : 0;
  }
  embree::Query query(embree::Coherence::incoherent);
  query.occluded(valid, scene, &rays);
  uint32_t bits = 0;
  for (std::size_t i = 0; i < N; ++i) bits |= (rays.tfar[i] < 0 ? 1U : 0U) << (first + i);
  return bits & wanted;
}

template <int N>
uint32_t trace_all(RTCScene scene, const Segments& s, uint32_t wanted) {
  uint32_t bits = 0;
  for (std::size_t first = 0; first < rays_per_call; first += N)
    if (wanted >> first & ((1U << N) - 1)) bits |= trace<N>(scene, s, first, wanted);
  return bits;
}

}  // namespace

uint32_t blocked_segments(const EmbreeHierarchy& hierarchy, const Segments& segments, uint32_t wanted) {
  switch (hierarchy.native_packet()) {
    case 16:
      return trace_all<16>(hierarchy.scene(), segments, wanted);
    case 8:
      return trace_all<8>(hierarchy.scene(), segments, wanted);
    default:
      return trace_all<4>(hierarchy.scene(), segments, wanted);
  }
}

}  // namespace penumbra::depth_complexity
