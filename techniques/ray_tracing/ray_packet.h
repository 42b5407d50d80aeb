// N shadow rays in Embree's layout, N = 1, 4, 8, 16, behind one spelling.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/vec.h"
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

// Set bits. Inline, where std::popcount is a call into the compiler's library on a baseline x86-64.
inline uint32_t bit_count(uint32_t v) {
  v -= v >> 1 & 0x55555555U;
  v = (v & 0x33333333U) + (v >> 2 & 0x33333333U);
  return ((v + (v >> 4)) & 0x0f0f0f0fU) * 0x01010101U >> 24;
}

// out = from - what, lane by lane: one vector operation, as nothing overlaps.
template <int N>
void subtract(float* __restrict out, const float* __restrict from, float what) {
  for (int i = 0; i < N; ++i) out[i] = from[i] - what;
}

template <int N>
class ShadowRays {
 public:
  explicit ShadowRays(bool light_at_infinity)
      // Hits count for 0 < t < 1, and Embree's upper end is inclusive.
      : far_(light_at_infinity ? std::numeric_limits<float>::infinity() : 0x1.fffffep-1F),
        to_light_(light_at_infinity ? 0.0F : 1.0F) {
    for (int i = 0; i < N; ++i) {
      lanes(rays_.tnear)[i] = lanes(rays_.time)[i] = 0;
      lanes(rays_.tfar)[i] = far_;
      lanes(rays_.mask)[i] = ~0U;
      lanes(rays_.id)[i] = lanes(rays_.flags)[i] = 0;
      all_valid_[i] = -1;
    }
  }

  // All lanes start at `origin`.
  void start(Vec3f origin) {
    for (int i = 0; i < N; ++i) start(i, origin);
    from_ = origin * to_light_;
  }
  void start(int lane, Vec3f origin) {
    lanes(rays_.org_x)[lane] = origin.x, lanes(rays_.org_y)[lane] = origin.y,
    lanes(rays_.org_z)[lane] = origin.z;
  }
  // Lane i goes to light sample (x[i], y[i], z[i]) from the common start; a sample at infinity is a direction
  // itself.
  void aim(const float* x, const float* y, const float* z) {
    subtract<N>(lanes(rays_.dir_x), x, from_.x);
    subtract<N>(lanes(rays_.dir_y), y, from_.y);
    subtract<N>(lanes(rays_.dir_z), z, from_.z);
  }
  // Every lane goes to light sample l from its own start.
  void aim(Vec3f l) {
    for (int i = 0; i < N; ++i) {
      lanes(rays_.dir_x)[i] = l.x - to_light_ * lanes(rays_.org_x)[i];
      lanes(rays_.dir_y)[i] = l.y - to_light_ * lanes(rays_.org_y)[i];
      lanes(rays_.dir_z)[i] = l.z - to_light_ * lanes(rays_.org_z)[i];
    }
  }

  // One lane goes to light sample l from its own start.
  void aim(int lane, Vec3f l) {
    lanes(rays_.dir_x)[lane] = l.x - to_light_ * lanes(rays_.org_x)[lane];
    lanes(rays_.dir_y)[lane] = l.y - to_light_ * lanes(rays_.org_y)[lane];
    lanes(rays_.dir_z)[lane] = l.z - to_light_ * lanes(rays_.org_z)[lane];
  }

  // Bit i set: lane i, one of `wanted`, is blocked.
  uint32_t blocked(RTCScene scene, embree::Query& query, uint32_t wanted) {
    if constexpr (N == 1) {
      query.occluded(scene, &rays_);
    } else if (wanted == (1U << N) - 1) {
      query.occluded(all_valid_, scene, &rays_);
    } else {
      for (int i = 0; i < N; ++i) valid_[i] = wanted >> i & 1 ? -1 : 0;
      query.occluded(valid_, scene, &rays_);
    }
    float* far = lanes(rays_.tfar);
    const uint32_t hit = below_zero<N>(far);  // Embree marks a blocked ray by tfar = -infinity
    if (hit)
      for (int i = 0; i < N; ++i) far[i] = far_;
    return hit;
  }

 private:
  alignas(64) typename EmbreeRays<N>::type rays_;
  alignas(64) int valid_[N], all_valid_[N];
  float far_, to_light_;
  Vec3f from_;
};

}  // namespace penumbra::ray_tracing
