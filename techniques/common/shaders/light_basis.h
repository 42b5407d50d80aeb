// A light as grouping and binning see it: a space to work in, and the corners of its convex hull. Shared by
// GLSL and C++.
#ifndef PENUMBRA_LIGHT_BASIS_H
#define PENUMBRA_LIGHT_BASIS_H
#ifdef __cplusplus
#include <cstddef>
#include <cstdint>

#include "core/vec.h"
namespace penumbra {
#define PENUMBRA_VEC4 Vec4f
#define PENUMBRA_UINT uint32_t
#else
#define PENUMBRA_VEC4 vec4
#define PENUMBRA_UINT uint
#endif

struct LightBasis {
  // working = (dot(row_x, d), dot(row_y, d), dot(row_z, d)) with d = world - origin.
  PENUMBRA_VEC4 row_x, row_y, row_z, origin;
  PENUMBRA_VEC4 corners[8];  // world; w = 0: a direction towards a light at infinity
  PENUMBRA_UINT corner_count;
  PENUMBRA_UINT front_only;            // 1: receivers with working z <= 0 are behind the light
  PENUMBRA_UINT padding_0, padding_1;  // no array: a uniform block would give each element 16 bytes
};

#ifdef __cplusplus
static_assert(sizeof(LightBasis) == 208 && offsetof(LightBasis, corner_count) == 192);
}  // namespace penumbra
#endif
#undef PENUMBRA_VEC4
#undef PENUMBRA_UINT
#endif
