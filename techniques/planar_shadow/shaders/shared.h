// Structs that GLSL and C++ share. Vectors of 4 come first in each, so that both languages lay them out
// alike.
#ifndef PENUMBRA_PLANAR_SHADOW_SHARED_H
#define PENUMBRA_PLANAR_SHADOW_SHARED_H
#ifdef __cplusplus
#include <cstdint>

#include "core/vec.h"
#define ADDRESS_OF(type) uint64_t
namespace penumbra::planar_shadow {
using uint = uint32_t;
using mat4 = Mat4f;
using vec4 = Vec4f;
#else
#define ADDRESS_OF(type) type
#define PLANAR_GROUP 64
#endif

struct FlattenPush {
  mat4 clip_from_world;  // onto the plane, then to the camera's clip space
  vec4 plane;            // distance from the plane, positive on the light's side
  float lowest;          // distances [lowest, highest] cast
  float highest;         // 0: the light is at infinity, nothing is beyond it
};

struct GatherPush {
  vec4 emission;  // axis, and cosine of the half angle about it in which the light leaves (-1: everywhere)
  ADDRESS_OF(UintArray) triangle;
  ADDRESS_OF(UintArray) on_receiver;  // a bit per triangle
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) normal;
  ADDRESS_OF(UintArray) stencil;  // slices of 8 light samples each; a byte per pixel, a bit per light sample
  ADDRESS_OF(Vec4Array) points;   // light samples
  ADDRESS_OF(FloatArray) weights;
  ADDRESS_OF(UintArray) dark;  // mask of the light samples that light no point of the receiver
  ADDRESS_OF(FloatArray) visibility;
  ADDRESS_OF(UintArray) mask;
  float weight;  // of every light sample; 0: they differ
  uint pixels;
  uint words;  // of a pixel's mask
  uint first;  // light samples first ... end; first is a multiple of 32
  uint end;
  uint unused;
};

#ifdef __cplusplus
static_assert(sizeof(FlattenPush) == 88 && sizeof(GatherPush) == 120);
}  // namespace penumbra::planar_shadow
#endif
#endif
