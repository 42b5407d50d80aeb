// Structs that GLSL and C++ share. Vectors of 4 come first in each, so that both languages lay them out
// alike.
#ifndef PENUMBRA_SHADOW_MAP_SHARED_H
#define PENUMBRA_SHADOW_MAP_SHARED_H
#ifdef __cplusplus
#include <cstdint>

#include "core/vec.h"
#define ADDRESS_OF(type) uint64_t
namespace penumbra::shadow_map {
using uint = uint32_t;
using mat4 = Mat4f;
using vec4 = Vec4f;
#else
#define ADDRESS_OF(type) type
#define SHADOW_MAP_GROUP 64
#endif

// One square depth map: the whole map, a cascade or a face.
struct MapLayer {
  mat4 clip_from_world;   // x, y in [-1, 1] over the map, depth in [0, 1] growing away from the light
  mat4 plane_from_world;  // its inverse transpose: takes planes where clip_from_world takes points
  vec4 linear_numerator;  // linear depth = dot(numerator, v) / dot(denominator, v), v = (clip x, clip y,
                          // depth, 1)
  vec4 linear_denominator;
  vec4 linear_from_world;  // linear depth of a point = dot(xyz, P) + w: distance along the map's axis
  vec4
      range;  // x, y: view depths [x, y) of the receivers that use this layer; z, w: linear depths of 0 and 1
  vec4 log_warp;      // x, y: a map coordinate y' = x log(-1 / y) + y in place of y; x = 0: y itself
  vec4 light_texels;  // texels per unit of (1/depth) that the light's edges span: edge u in xy, edge v in zw
};

// Smallest and largest value over the view samples, as order-preserving integers; `hi` is complemented so
// that both are minima and one fill resets them.
struct SampleBounds {
  uint lo[4];  // x, y, z in the space asked for; view depth
  uint hi[4];
  uint outside;  // 0 when a view sample that faces the light was beyond the query's limit or behind the
                 // light's plane
  uint unused[3];
};

// What fit.comp is asked: the bounds of which view samples, in which space.
struct FitQuery {
  mat4 space_from_world;
  vec4 light;     // position, 1; or the direction towards a light at infinity, 0
  vec4 emission;  // axis, and cosine of the half angle about it in which light leaves (-1: everywhere)
  vec4 range;     // samples of view depth [x, y) and of |x/w|, |y/w| <= z alone
};

struct FitPush {
  ADDRESS_OF(QueryArray) query;
  ADDRESS_OF(BoundsArray) bounds;
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) normal;
  uint count;  // pixels
  uint slot;   // of query and bounds
};

struct DepthPush {
  mat4 clip_from_world;
};

// The depth pass of logarithmic maps: each triangle as the quad around its curved image.
struct LogDepthPush {
  mat4 clip_from_world;
  ADDRESS_OF(Vec3Array) positions;
  ADDRESS_OF(UintArray) indices;
  float log_scale;
  float log_offset;
  float slope_bias;
  float map_size;
};

struct LookupPush {
  vec4 light;  // as FitQuery
  vec4 emission;
  ADDRESS_OF(Vec4Array) position;
  ADDRESS_OF(Vec4Array) origin;
  ADDRESS_OF(Vec4Array) normal;
  ADDRESS_OF(LayerArray) layers;
  ADDRESS_OF(Vec2Array) disc;     // percentage-closer filters
  ADDRESS_OF(UintArray) moments;  // filterable maps
  ADDRESS_OF(FloatArray) visibility;
  ADDRESS_OF(Vec4Array)
  camera;      // filterable maps with levels: the eye, and a pixel's step right and down at unit depth
  uint count;  // pixels
  uint layer_count;
  float constant_bias;  // scene units
  float bleeding_reduction;
  float variance_or_bias;  // min_variance, or moment_bias
  uint max_probes;         // 1: no anisotropic filtering
};

struct MomentsPush {
  ADDRESS_OF(LayerArray) layers;
  ADDRESS_OF(UintArray) from;  // blur and halve_moments alone
  ADDRESS_OF(UintArray) to;
  uint layer;
  uint level;  // made by halve_moments
};

#ifdef __cplusplus
static_assert(sizeof(MapLayer) == 224 && sizeof(FitQuery) == 112 && sizeof(SampleBounds) == 48);
static_assert(sizeof(FitPush) == 40 && sizeof(DepthPush) == 64 && sizeof(LogDepthPush) == 96);
static_assert(sizeof(LookupPush) == 120 && sizeof(MomentsPush) == 32);
}  // namespace penumbra::shadow_map
#endif
#endif
