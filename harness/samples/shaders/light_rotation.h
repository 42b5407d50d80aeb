// Per-pixel rotation of light samples, for GLSL and C++: what a pixel draws, from integers and a few rounded
// operations, so that host and device agree to rounding (shifts exactly).
#ifndef PENUMBRA_LIGHT_ROTATION_H
#define PENUMBRA_LIGHT_ROTATION_H
#ifdef __cplusplus
#include <cstdint>

namespace penumbra::light_rotation {
#define PENUMBRA_UINT uint32_t
#define PENUMBRA_INLINE inline
#define PENUMBRA_OUT(type) type&
#else
#define PENUMBRA_UINT uint
#define PENUMBRA_INLINE
#define PENUMBRA_OUT(type) out type
#endif

PENUMBRA_INLINE PENUMBRA_UINT rotation_hash(PENUMBRA_UINT v) {  // [Jarzynski 2020, PCG]
  PENUMBRA_UINT state = v * 747796405u + 2891336453u;
  PENUMBRA_UINT word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

// Draw `dimension` of a pixel: 32 random bits.
PENUMBRA_INLINE PENUMBRA_UINT rotation_bits(PENUMBRA_UINT pixel, PENUMBRA_UINT seed,
                                            PENUMBRA_UINT dimension) {
  return rotation_hash(rotation_hash(rotation_hash(seed) + pixel) + dimension);
}

// In [0, 1), 24 bits: exact in single precision.
PENUMBRA_INLINE float rotation_unit(PENUMBRA_UINT pixel, PENUMBRA_UINT seed, PENUMBRA_UINT dimension) {
  return float(rotation_bits(pixel, seed, dimension) >> 8u) * 5.9604644775390625e-8f;
}

// Cosine and sine of a pixel's angle, uniform over the circle: a quadrant, and an angle within 45 degrees by
// Taylor polynomials (error below 4e-9). The device's own functions may be off by 2^-11.
PENUMBRA_INLINE void rotation_turn(PENUMBRA_UINT pixel, PENUMBRA_UINT seed, PENUMBRA_OUT(float) cosine,
                                   PENUMBRA_OUT(float) sine) {
  PENUMBRA_UINT bits = rotation_bits(pixel, seed, 0u), quadrant = bits >> 30u;
  float x = (float((bits >> 6u) & 0xffffffu) * 5.9604644775390625e-8f - 0.5f) * 1.57079632679f, q = x * x;
  float s = x * (1.0f - q * (1.0f / 6.0f) *
                            (1.0f - q * (1.0f / 20.0f) * (1.0f - q * (1.0f / 42.0f) * (1.0f - q / 72.0f))));
  float c =
      1.0f - q * 0.5f *
                 (1.0f - q * (1.0f / 12.0f) *
                             (1.0f - q * (1.0f / 30.0f) * (1.0f - q * (1.0f / 56.0f) * (1.0f - q / 90.0f))));
  bool odd = (quadrant & 1u) == 1u, back = quadrant >= 2u;
  float cs = odd ? -s : c, sn = odd ? c : s;
  cosine = back ? -cs : cs;
  sine = back ? -sn : sn;
}

#undef PENUMBRA_UINT
#undef PENUMBRA_INLINE
#undef PENUMBRA_OUT
#ifdef __cplusplus
}  // namespace penumbra::light_rotation
#endif
#endif
