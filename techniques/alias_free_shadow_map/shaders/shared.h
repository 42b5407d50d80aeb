// Structs that GLSL and C++ share, in scalar layout. Vectors of 4 come first, so that both languages lay them
// out alike.
#ifndef PENUMBRA_ALIAS_FREE_SHARED_H
#define PENUMBRA_ALIAS_FREE_SHARED_H
#ifdef __cplusplus
#include <cstddef>
#include <cstdint>

#include "core/vec.h"
#define ADDRESS_OF(type) uint64_t
namespace penumbra::alias_free {
using uint = uint32_t;
using vec4 = Vec4f;
#define SHARED_CONSTANT inline constexpr uint
#else
#define ADDRESS_OF(type) type
#define SHARED_CONSTANT const uint
#endif

SHARED_CONSTANT most_faces = 6u;
SHARED_CONSTANT group_lanes = 64u;
SHARED_CONSTANT samples_per_lane = 16u;  // of the bounds' reduction
SHARED_CONSTANT triangles_per_lane = 8u;
SHARED_CONSTANT small_rows =
    16u;  // triangles over at most so many rows of texels are done by one invocation,
SHARED_CONSTANT small_range = 128u;  // as far as their rows hold at most so many view samples each
SHARED_CONSTANT item_rows = 16u;     // all else becomes items of so many rows, done by as many invocations
SHARED_CONSTANT most_inner = 256u;   // view samples on a closed mesh's inside that are tested one by one
SHARED_CONSTANT front_block = 64u;   // triangles with a box in common
SHARED_CONSTANT all_rows = 0xffffffffu;  // more than small_rows of them
SHARED_CONSTANT no_slot = 0xffffffffu;
SHARED_CONSTANT not_listed = 0xffffffffu;  // a view sample that faces away from the light

// A window of the light's view, divided into grid_size x grid_size texels. With q relative to
// LightView::center: u = dot(right, q) / depth, v = dot(down, q) / depth, depth = dot(forward, q), or 1 for a
// light at infinity.
struct Face {
  vec4 right, down, forward;  // w unused
  vec4 window;                // lower corner (u, v); texels per unit of u and v
  vec4 slack;                 // x, y: texels that rounding may move u and v by; z: bound of |q| / depth
};

struct LightView {
  vec4 light;     // position, 1; or the unit direction towards a light at infinity, 0
  vec4 emission;  // axis, cosine of the half angle about it in which light leaves (-1: everywhere)
  vec4 center;    // q = P - center: the light's position, or the middle of the scene for a light at infinity
  vec4 sample_lo, sample_hi;  // box of the shadow segments' beginnings
  Face faces[6];
  uint face_count;  // 1, or 6: the faces of a cube about the light
  uint grid_size;
  uint unused0, unused1;
};

// Minima of order-preserving integers (`hi` complemented), reset by one fill with ones.
struct SampleBounds {
  uint lo[3], hi[3];
  uint outside;  // 0 when a view sample is beyond the limit
  uint unused;
};

struct Progress {
  uint item_count;
  uint longest;      // view samples of the longest row range among the items
  uint pairs[2];     // triangles tested against view samples (counting only): low, high word
  uint inner_count;  // view samples on the inside of closed meshes, and the places of the first
  uint inner[256];
  uint crowded_count;  // triangles that are not done at once
  uint unused0, unused1;
};

struct BoundsPush {
  ADDRESS_OF(FrameRef) frame;
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) origin;
  ADDRESS_OF(Vec4Array) normal;
  ADDRESS_OF(UintArray) triangle;
  ADDRESS_OF(UVec4Array) samples;
  ADDRESS_OF(BoundsArray) bounds;
  uint count;   // pixels
  uint face;    // whose (u, v) are bounded
  float limit;  // of |u| and |v|
  uint unused;
};

struct BinPush {
  ADDRESS_OF(FrameRef) frame;
  ADDRESS_OF(UVec4Array)
  samples;                     // per pixel: where its shadow segment begins; its own triangle, or not_listed
  ADDRESS_OF(UintArray) away;  // as FacingPush
  ADDRESS_OF(ProgressRef) progress;
  ADDRESS_OF(UintArray) lengths;  // per texel
  ADDRESS_OF(UintArray) offsets;  // per texel
  ADDRESS_OF(UintArray) texels;   // per pixel: its texel; no_slot: in no list
  ADDRESS_OF(UintArray) slots;    // per pixel: its place in its texel's list, then in the array of all lists
  ADDRESS_OF(UVec4Array) lists;   // samples in the order of the lists
  uint count;
  uint unused;
};

struct CornersPush {
  ADDRESS_OF(Vec3Array) positions;
  ADDRESS_OF(UintArray) indices;
  ADDRESS_OF(UintArray) closed;   // a bit per triangle
  ADDRESS_OF(Vec4Array) corners;  // 3 per triangle; w of the first: 1 in closed meshes, else 0
  uint count;
  uint unused;
};

struct FacingPush {
  vec4 light;                  // as LightView
  ADDRESS_OF(UintArray) away;  // per triangle: 1 when it is of a closed mesh and turned away from the light
  // Triangles that cast, from the front; from the back those of closed meshes that face the light, which cast
  // on inner view samples alone.
  ADDRESS_OF(UintArray) casters;
  ADDRESS_OF(UintArray) counts;  // of both
  ADDRESS_OF(Vec4Array) boxes;   // two corners per front_block triangles from the back
  uint count;
  uint both_faces;  // 1: triangles of closed meshes cast with both sides
};

struct CastPush {
  ADDRESS_OF(UintArray) offsets;
  ADDRESS_OF(UintArray) blocked;  // 1 or 0 per view sample, in the order of the lists
  ADDRESS_OF(UintArray) casters;  // as FacingPush
  // Triangle; a bit per row, from its first on, that holds more than small_range view samples, or all_rows.
  ADDRESS_OF(ItemArray) crowded;
  ADDRESS_OF(ItemArray) items;  // triangle; first row, rows
  ADDRESS_OF(Vec4Array) boxes;  // as FacingPush
  ADDRESS_OF(ProgressRef) progress;
  uint face;
  uint first;   // caster, or view sample of each range of an item
  uint count;   // triangles, casters or items
  uint groups;  // dispatched, for their interleaving
};

struct ResolvePush {
  ADDRESS_OF(UintArray) slots;
  ADDRESS_OF(UintArray) blocked;
  ADDRESS_OF(FloatArray) visibility;
  uint count;
  uint unused;
};

#ifdef __cplusplus
static_assert(sizeof(Face) == 80 && sizeof(LightView) == 80 + 6 * 80 + 16 &&
              offsetof(LightView, face_count) == 560);
static_assert(sizeof(SampleBounds) == 32 && sizeof(Progress) == 264 * 4 && sizeof(BoundsPush) == 72);
static_assert(sizeof(BinPush) == 80 && sizeof(CastPush) == 72 && sizeof(FacingPush) == 56 &&
              sizeof(CornersPush) == 40 && sizeof(ResolvePush) == 32);
}  // namespace penumbra::alias_free
#endif
#undef SHARED_CONSTANT
#endif
