// Upper bounds of visibility from filtered moments of depth. GLSL and C++ compile the same lines: the tests
// hold them against double precision. Depths are in [0, 1]; a result is 1 where lit.
#ifndef PENUMBRA_SHADOW_MAP_MOMENT_FILTERS_H
#define PENUMBRA_SHADOW_MAP_MOMENT_FILTERS_H
#ifdef __cplusplus
#include <algorithm>
#include <cmath>
namespace penumbra::shadow_map::filters {
using std::clamp, std::exp, std::max, std::min, std::sqrt;
#define INLINE inline
#else
#define INLINE
#endif

// The one-tailed inequality of Chebyshev [Donnelly2006].
INLINE float chebyshev(float mean, float mean_of_squares, float depth, float least_variance) {
  if (depth <= mean) return 1.0f;
  float variance = max(mean_of_squares - mean * mean, least_variance);
  float beyond = depth - mean;
  return variance / (variance + beyond * beyond);
}

// What is below `amount` becomes dark: light that bleeds in where occluders overlap [Lauritzen2008].
INLINE float reduce_bleeding(float visibility, float amount) {
  return clamp((visibility - amount) / (1.0f - amount), 0.0f, 1.0f);
}

// Exponential warps of depth; the negative one grows with depth too [Lauritzen2008].
INLINE float warp_positive(float depth, float c) { return exp(c * (2.0f * depth - 1.0f)); }
INLINE float warp_negative(float depth, float c) { return -exp(-c * (2.0f * depth - 1.0f)); }
// The least variance follows the warp's slope.
INLINE float warped_variance(float warped, float c, float least_variance) {
  return least_variance * 4.0f * c * c * warped * warped;
}

// Hamburger four moment shadow mapping [Peters2015]: the sharpest lower bound of shadow that four moments
// allow.
INLINE float four_moments(float m1, float m2, float m3, float m4, float depth, float moment_bias) {
  float b0 = m1 + (0.5f - m1) * moment_bias, b1 = m2 + (0.5f - m2) * moment_bias;
  float b2 = m3 + (0.5f - m3) * moment_bias, b3 = m4 + (0.5f - m4) * moment_bias;
  // L D L^T of the Hankel matrix (1, b0, b1; b0, b1, b2; b1, b2, b3).
  float l21d11 = b2 - b0 * b1, d11 = max(b1 - b0 * b0, 1e-20f);
  float l21 = l21d11 / d11;
  float d22 = max(b3 - b1 * b1 - l21d11 * l21, 1e-20f);
  // Solve for the polynomial whose roots, beside `depth`, support the extremal distribution.
  float c0 = 1.0f, c1 = depth - b0, c2 = depth * depth - b1 - l21 * (depth - b0);
  if (c2 == 0.0f) return 1.0f;  // `depth` is all that the moments hold
  c1 = c1 / d11;
  c2 = c2 / d22;
  c1 = c1 - l21 * c2;
  c0 = c0 - (c1 * b0 + c2 * b1);
  float p = c1 / c2, q = c0 / c2;
  float r = sqrt(max(0.25f * p * p - q, 0.0f));
  float z1 = -0.5f * p - r, z2 = -0.5f * p + r;
  if (depth <= z1) return 1.0f;
  float a = depth, b = z1, base = 0.0f;
  if (depth > z2) {
    a = z1;
    b = depth;
    base = 1.0f;
  }
  float spread = (z2 - b) * (depth - z1);
  if (spread == 0.0f) return 1.0f - base;  // two of the three depths coincide
  float quotient = (a * z2 - b0 * (a + z2) + b1) / spread;
  // Written so that what rounding made of no variance at all (NaN) counts as lit.
  float shadow = base + quotient;
  return shadow > 0.0f ? max(1.0f - shadow, 0.0f) : 1.0f;
}

#undef INLINE
#ifdef __cplusplus
}  // namespace penumbra::shadow_map::filters
#endif
#endif
