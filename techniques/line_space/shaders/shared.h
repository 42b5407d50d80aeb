// Structs that GLSL and C++ share, in scalar layout.
#ifndef PENUMBRA_LINE_SPACE_SHARED_H
#define PENUMBRA_LINE_SPACE_SHARED_H
#ifdef __cplusplus
#include <cstddef>
#include <cstdint>

#include "core/vec.h"
#define ADDRESS_OF(type) uint64_t
namespace penumbra::line_space {
using uint = uint32_t;
using vec3 = Vec3f;
using vec4 = Vec4f;
#define SHARED_CONSTANT inline constexpr uint
#else
#define ADDRESS_OF(type) type
#define SHARED_CONSTANT const uint
#endif

// Entries of the tree pool that are no node: what is at least occupied_leaf is not subdivided.
SHARED_CONSTANT occupied_leaf = 0xfffffffeu;  // holds geometry, below the finest subdivided nodes
SHARED_CONSTANT empty_leaf = 0xffffffffu;
// What a walk skips where it begins; see params.cpp.
SHARED_CONSTANT start_node = 0u, start_neighbours = 1u, start_coarse = 2u;
SHARED_CONSTANT group_lanes = 64u;
SHARED_CONSTANT tile_side = 8u;  // a group's pixels are a square

SHARED_CONSTANT word_row = 4096u;  // texels of four words in a row of shaders/words.glsl

// An entry of the node pool.
struct Node {
  uint children;  // place of its children group in the tree pool
  uint x, y, z;   // its lowest corner, in leaves; its size follows from its level
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer NodeArray { Node at[]; };
#endif

struct OccupyPush {
  ADDRESS_OF(Vec3Array) positions;
  ADDRESS_OF(UintArray) indices;
  ADDRESS_OF(UintArray) pairs;  // triangle, node of the level
  ADDRESS_OF(NodeArray) nodes;
  ADDRESS_OF(UintArray) occupancy;    // a bit per subnode, whole words per node
  ADDRESS_OF(UintArray) counts;       // per pair: subnodes that its triangle overlaps; their prefix sums
  ADDRESS_OF(UintArray) first_child;  // per node, in the next level
  ADDRESS_OF(UintArray) next_pairs;
  vec3 lo, scale, padding;  // of the grid, in leaves
  uint count;               // pairs
  uint subnode;             // leaves a side
};

struct ChildrenPush {
  ADDRESS_OF(NodeArray) nodes;
  ADDRESS_OF(UintArray) occupancy;
  ADDRESS_OF(UintArray) counts;  // per node: occupied subnodes
  ADDRESS_OF(UintArray) first_child;
  ADDRESS_OF(NodeArray) next_nodes;
  uint count;    // nodes
  uint subnode;  // leaves a side
};

struct FillPush {
  ADDRESS_OF(NodeArray) nodes;  // of the level
  ADDRESS_OF(UintArray) occupancy;
  ADDRESS_OF(UintArray) first_child;
  ADDRESS_OF(NodeArray) node_pool;
  ADDRESS_OF(UintArray) tree_pool;
  uint count;       // nodes
  uint base;        // the level's first node
  uint next_base;   // the next level's
  uint last_level;  // 1: occupied subnodes are leaves
};

struct LineSpacePush {
  ADDRESS_OF(UintArray) occupancy;
  ADDRESS_OF(UintArray) line_space_pool;
  uint count;  // nodes
  uint base;   // the level's first node
};

struct TraceConstants {
  vec4 emission;  // as in light_emission.glsl
  vec4 lo;        // of the root node
  vec4 scale;     // fine cells per world unit
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer TraceConstantsRef {
  TraceConstants values;
};
#endif

struct TracePush {
  ADDRESS_OF(TraceConstantsRef) constants;
  ADDRESS_OF(UintArray) triangle;
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) origin;
  ADDRESS_OF(Vec4Array) normal;
  ADDRESS_OF(Vec4Array) points;  // light samples
  ADDRESS_OF(UintArray) tree_pool;
  ADDRESS_OF(UintArray) line_space_pool;
  ADDRESS_OF(UintArray) mask;
  uint width, height;
  uint words;       // of a pixel's mask
  uint first, end;  // light samples, all of one word
};

struct ResolvePush {
  ADDRESS_OF(UintArray) mask;
  ADDRESS_OF(FloatArray) weights;
  ADDRESS_OF(FloatArray) visibility;
  float weight;  // of every light sample; 0: they differ
  uint pixels;
  uint words;
  uint samples;
};

#ifdef __cplusplus
static_assert(sizeof(Node) == 16 && sizeof(OccupyPush) == 112 && sizeof(ChildrenPush) == 48);
static_assert(sizeof(FillPush) == 56 && sizeof(LineSpacePush) == 24 && sizeof(TraceConstants) == 48);
static_assert(sizeof(TracePush) == 96 && offsetof(TracePush, width) == 72 && sizeof(ResolvePush) == 40);
}  // namespace penumbra::line_space
#endif
#undef SHARED_CONSTANT
#endif
