// Structs that GLSL and C++ share. Vectors of 4 come first in each, so that both languages lay them out
// alike.
#ifndef PENUMBRA_SOFT_SHADOW_VOLUME_SHARED_H
#define PENUMBRA_SOFT_SHADOW_VOLUME_SHARED_H
#ifdef __cplusplus
#include <cstdint>

#include "core/vec.h"
#define ADDRESS_OF(type) uint64_t
#define CONSTANT inline constexpr uint32_t
namespace penumbra::soft_shadow_volume {
using uint = uint32_t;
using mat4 = Mat4f;
using vec4 = Vec4f;
#else
#define ADDRESS_OF(type) type
#define CONSTANT const uint
#define WEDGE_GROUP 64
#endif

// Shapes that a light has as seen from a view sample.
CONSTANT SHAPE_RECTANGLE = 0;
CONSTANT SHAPE_DISC = 1;  // of a sphere: through its centre, facing the view sample
CONSTANT SHAPE_POINT = 2;
CONSTANT SHAPE_TEXTURE = 3;

// A light, or a part of a split one.
struct AreaLight {
  vec4 center;   // and radius (sphere), or half the diagonal (rectangle)
  vec4 scale_u;  // rectangle: 2 edge_u / |edge_u|^2, so that it spans -1 to 1
  vec4 scale_v;  // w of both: first row and number of rows of its texture
};

// Which side of an edge hides the light, and where the volumes' sides are, is decided for one point of the
// light, its pivot: the centre moved by this much (of half the light's extent along x and y), so that it lies
// in no common plane of edges and eye, as the centre does in symmetric scenes.
#define PIVOT_X 1.1e-5f
#define PIVOT_Y 0.7e-5f

struct Silhouette {
  uint vertex[2];
  int weight;  // times that the edge runs vertex[0] -> vertex[1] around casters that turn their back to the
               // light
  uint unused;
};

// Rings have at most this many directions; see wedges.comp.
CONSTANT MOST_DIRECTIONS = 8;
// Vertices of a wedge: its apexes, then its ring.
CONSTANT WEDGE_VERTICES = 10;
// Sides: two triangles for each ray; the far cap: a fan.
CONSTANT WEDGE_INDICES = 66;
// In place of the number of directions: the wedge covers the whole picture.
CONSTANT WHOLE_PICTURE = 9;

// The convex hull of what an edge hides parts of the light from: apexes, and directions to points at
// infinity.
struct Wedge {
  vec4 edge[2];  // its ends; w of the first: the silhouette's weight, of the second: number of directions, or
                 // 0
  vec4 apex[2];
  vec4 ring[8];  // w: the apex that it starts from
};

struct Extraction {
  int eye_count;   // volumes that hold the eye
  uint near_caps;  // vertices in the list
};

struct ExtractPush {
  vec4 light;  // pivot; w: distance from the eye up to which casters may be cut by the near plane
  vec4 eye;    // w: unused
  ADDRESS_OF(Vec3Array) positions;
  ADDRESS_OF(UintArray) indices;
  ADDRESS_OF(UintArray) casts;   // per triangle
  ADDRESS_OF(UintArray) turned;  // per triangle: 1 when it casts and turns its back to the light
  ADDRESS_OF(UVec4Array) edges;  // two vertices, first face, face count
  ADDRESS_OF(UintArray) faces;   // triangle * 2, + 1 when it runs the edge backwards
  ADDRESS_OF(UintArray) marks;   // per edge: 1 for silhouettes
  ADDRESS_OF(UintArray) places;  // per edge: of the silhouette
  ADDRESS_OF(SilhouetteArray) silhouettes;
  ADDRESS_OF(ExtractionRef) extraction;
  uint count;  // triangles or edges
};

struct WedgesPush {
  AreaLight light;
  vec4 lo, hi;  // bounds of the scene
  ADDRESS_OF(Vec3Array) positions;
  ADDRESS_OF(SilhouetteArray) silhouettes;
  ADDRESS_OF(WedgeArray) wedges;
  ADDRESS_OF(UintArray) indices;  // out: WEDGE_INDICES for each
  uint count;
  uint loose;
};

// Sides of shadow volumes, near caps and wedges.
struct DrawPush {
  mat4 clip_from_world;
  vec4 center;  // the light's pivot; w: see end
  ADDRESS_OF(Vec3Array) positions;
  ADDRESS_OF(SilhouetteArray) silhouettes;  // sides
  ADDRESS_OF(ExtractionRef) caps;           // near caps
  ADDRESS_OF(UintArray) indices;            // near caps: of the mesh
  ADDRESS_OF(UintArray) seen;               // near caps: triangle of each pixel
  uint width;
  float end;  // sides: where they end, on axis center.w (0, 1, 2); at infinity where that is -1
};
struct WedgePush {
  mat4 clip_from_world;
  vec4 pivot, scale_u, scale_v;  // as AreaLight, with the pivot for the centre
  ADDRESS_OF(WedgeArray) wedges;
};

// Of a view sample: how much of the light is above its horizon.
CONSTANT CLASS_DARK = 0;
CONSTANT CLASS_WHOLE = 1;
CONSTANT CLASS_CUT = 2;

struct ClassifyPush {
  AreaLight light;
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) normal;
  ADDRESS_OF(Vec4Array) classed;  // out: normal, class
  ADDRESS_OF(FloatArray) depth_whole;
  ADDRESS_OF(FloatArray) depth_cut;
  uint count;
  float near_plane;
};

struct ResolvePush {
  AreaLight light;
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) normal;
  ADDRESS_OF(Vec2Array) sums;  // of volumes, of coverage
  ADDRESS_OF(FloatArray) visibility;
  ADDRESS_OF(ExtractionRef) extraction;
  uint count;
  uint first;   // 1: starts the sum over the parts of a split light
  float share;  // of this part
  uint unused;
};

#ifdef __cplusplus
static_assert(sizeof(AreaLight) == 48 && sizeof(Silhouette) == 16 && sizeof(Wedge) == 192);
static_assert(sizeof(ExtractPush) == 120 && sizeof(WedgesPush) == 120 && sizeof(DrawPush) == 128);
static_assert(sizeof(WedgePush) == 120 && sizeof(ResolvePush) == 104 && sizeof(ClassifyPush) == 96);
}  // namespace penumbra::soft_shadow_volume
#endif
#endif
