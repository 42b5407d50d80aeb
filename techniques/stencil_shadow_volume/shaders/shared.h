// Structs that GLSL and C++ share. Vectors of 4 come first in each, so that both languages lay them out
// alike.
#ifndef PENUMBRA_SHADOW_VOLUME_SHARED_H
#define PENUMBRA_SHADOW_VOLUME_SHARED_H
#ifdef __cplusplus
#include <cstdint>

#include "core/vec.h"
#define ADDRESS_OF(type) uint64_t
#define CONSTANT inline constexpr uint32_t
namespace penumbra::shadow_volume {
using uint = uint32_t;
using mat4 = Mat4f;
using vec4 = Vec4f;
#else
#define ADDRESS_OF(type) type
#define CONSTANT const uint
#define VOLUME_GROUP 64
#endif

// The lists that a frame's volumes consist of: indices of vertices, where v + vertex_count stands for vertex
// v moved away from the light to infinity, and 2 vertex_count for the apex of the far cap.
CONSTANT LIST_SIDES = 0;
CONSTANT LIST_NEAR_FRONT = 1;  // triangles that face the light, in the mesh's own order
CONSTANT LIST_NEAR_BACK = 2;   // triangles that turn their back to it
CONSTANT LIST_FAR = 3;
CONSTANT LIST_COUNT = 4;

CONSTANT MAKE_SIDES = 1;  // per triangle
CONSTANT MAKE_NEAR = 2;
CONSTANT MAKE_FAR = 4;
CONSTANT BACK_FACING_ONLY = 8;  // of the casters

// VkDrawIndexedIndirectCommand.
struct DrawArguments {
  uint index_count, instance_count, first_index;
  int vertex_offset;
  uint first_instance;
};
struct Draws {
  DrawArguments list[4];
  uint silhouette_edges, quads;
};

struct ExtractPush {
  vec4 light;  // position, 1; or the direction towards a light at infinity, 0
  ADDRESS_OF(Vec3Array) positions;
  ADDRESS_OF(UintArray) indices;
  ADDRESS_OF(IntArray)
  facing;  // per triangle: 1 casts facing the light, -1 with its back to it, 0 does not cast
  ADDRESS_OF(UVec4Array) edges;  // two vertices, first face, face count
  ADDRESS_OF(UintArray) faces;   // triangle * 2, + 1 when it runs the edge backwards
  ADDRESS_OF(ListsRef) lists;
  ADDRESS_OF(DrawsRef) draws;
  uint count;  // triangles or edges
  uint vertex_count;
  uint indices_per_quad;  // 3: the light is at infinity, both far corners are one; 6; 9: with its part of the
                          // far cap
  uint make;              // MAKE_*
};

struct Lists {
  ADDRESS_OF(UintArray) at[4];
};

struct VolumePush {
  mat4 clip_from_world;
  vec4 light;
  vec4 apex;  // direction of the far cap's apex
  ADDRESS_OF(Vec3Array) positions;
  uint vertex_count;
  uint unused;
};

struct ResolvePush {
  vec4 light;
  vec4 emission;  // axis, and cosine of the half angle about it in which light leaves (-1: everywhere)
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) normal;
  ADDRESS_OF(UintArray) counts;  // a byte per pixel, or a float
  ADDRESS_OF(FloatArray) visibility;
  uint count;
  uint unused;
};

#ifdef __cplusplus
static_assert(sizeof(DrawArguments) == 20 && sizeof(Draws) == 88 && sizeof(Lists) == 32);
static_assert(sizeof(ExtractPush) == 88 && sizeof(VolumePush) == 112 && sizeof(ResolvePush) == 72);
}  // namespace penumbra::shadow_volume
#endif
#endif
