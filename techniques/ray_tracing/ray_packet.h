// N shadow rays in Embree's layout, N = 1, 4, 8, 16, behind one spelling.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>

#include "embree/embree.h"
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace penumbra::ray_tracing {

template <int N>
struct EmbreeRays;
template <>
struct EmbreeRays<1> {
  using type = RTCRay;
};
template <>
struct EmbreeRays<4> {
  using type = RTCRay4;
};
template <>
struct EmbreeRays<8> {
  using type = RTCRay8;
};
template <>
struct EmbreeRays<16> {
  using type = RTCRay16;
};

// A field of a packet, or of a single ray, as N lanes.
template <class T>
T* lanes(T& field) {
  return &field;
}
template <class T, std::size_t n>
T* lanes(T (&field)[n]) {
  return field;
}

// Bit i set: value i < 0.
template <int N>
uint32_t below_zero(const float* values) {
  uint32_t bits = 0;
#if defined(__SSE__)
  if constexpr (N >= 4) {
    for (int i = 0; i < N; i += 4)
      bits |= static_cast<uint32_t>(_mm_movemask_ps(_mm_cmplt_ps(_mm_loadu_ps(values + i), _mm_setzero_ps())))
              << i;
    return bits;
  }
#endif
  for (int i = 0; i < N; ++i) bits |= (values[i] < 0 ? 1U : 0U) << i;
  return bits;
}

template <int N>
class ShadowRays {
 public:
  // far: the largest t that counts. Hits count for 0 < t < 1, and Embree's upper end is inclusive.
  explicit ShadowRays(bool light_at_infinity)
      : far_(light_at_infinity ? std::numeric_limits<float>::infinity() : 0x1.fffffep-1F) {
    for (int i = 0; i < N; ++i) {
      lanes(rays_.tnear)[i] = lanes(rays_.time)[i] = 0;
      lanes(rays_.mask)[i] = ~0U;
      lanes(rays_.id)[i] = lanes(rays_.flags)[i] = 0;
    }
  }

  float* origin_x() { return lanes(rays_.org_x); }
  float* origin_y() { return lanes(rays_.org_y); }
  float* origin_z() { return lanes(rays_.org_z); }
  float* direction_x() { return lanes(rays_.dir_x); }
  float* direction_y() { return lanes(rays_.dir_y); }
  float* direction_z() { return lanes(rays_.dir_z); }

  // Bit i set: lane i, one of `wanted`, is blocked.
  uint32_t blocked(RTCScene scene, embree::Query& query, uint32_t wanted) {
    float* far = lanes(rays_.tfar);
    for (int i = 0; i < N; ++i) far[i] = far_;
    if constexpr (N == 1) {
      query.occluded(scene, &rays_);
    } else {
      for (int i = 0; i < N; ++i) valid_[i] = wanted >> i & 1 ? -1 : 0;
      query.occluded(valid_, scene, &rays_);
    }
    return below_zero<N>(far) & wanted;  // Embree marks a blocked ray by tfar = -infinity
  }

 private:
  alignas(64) typename EmbreeRays<N>::type rays_;
  alignas(64) int valid_[N];
  float far_;
};

}  // namespace penumbra::ray_tracing
