// Structs that GLSL and C++ share, in scalar layout. Buffers are reached by address.
#ifndef PENUMBRA_@NAME@_SHARED_H
#define PENUMBRA_@NAME@_SHARED_H
#ifdef __cplusplus
#include <cstdint>

#include "core/vec.h"
#define ADDRESS_OF(type) uint64_t
#define SHARED_CONSTANT inline constexpr uint32_t
namespace penumbra::@name@ {
using uint = uint32_t;
using vec4 = Vec4f;
#else
#define ADDRESS_OF(type) type
#define SHARED_CONSTANT const uint
#endif

SHARED_CONSTANT group_lanes = 64u;

struct LightConstants {
  vec4 emission;  // as in light_emission.glsl
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer LightConstantsRef {
  LightConstants values;
};
#endif

struct OccludePush {
  ADDRESS_OF(LightConstantsRef) light;
  ADDRESS_OF(Vec4Array) points;  // light samples: w = 1 a position, w = 0 a direction
  ADDRESS_OF(Vec3Array) positions;
  ADDRESS_OF(UintArray) indices;
  ADDRESS_OF(UintArray) triangle;  // of each pixel's view sample
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) origin;
  ADDRESS_OF(Vec4Array) normal;
  ADDRESS_OF(UintArray) mask;  // 1 = blocked
  uint pixels;
  uint words;       // of a pixel's mask
  uint samples;     // light samples
  uint first, end;  // triangles of this dispatch
};

#ifdef __cplusplus
static_assert(sizeof(LightConstants) == 16 && sizeof(OccludePush) == 96);
}  // namespace penumbra::@name@
#endif
#undef SHARED_CONSTANT
#undef ADDRESS_OF
#endif
