// What GLSL and C++ share: constants of one frame, and the layout of buffers.
#ifndef PENUMBRA_SAMPLE_BASED_SOFT_SHARED_H
#define PENUMBRA_SAMPLE_BASED_SOFT_SHARED_H
#include "techniques/common/shaders/light_basis.h"
#ifdef __cplusplus
namespace penumbra::sample_based_soft {
#define PENUMBRA_VEC4 Vec4f
#define PENUMBRA_UINT uint32_t
#else
#define PENUMBRA_VEC4 vec4
#define PENUMBRA_UINT uint
#endif

// Working space (see LightBasis): z is the distance before the light. For a regular grid of light samples its
// unit is one light sample, and sample (i, j) lies at (i, j, 0); for other sets on a rectangle the world,
// turned and moved; for spheres and volumes scaled too, so that the light's bounding ellipsoid becomes the
// unit sphere about the origin [Sintorn2008, sec. 4.1].
struct FrameConstants {
  LightBasis light;
  PENUMBRA_VEC4 light_lo, light_hi;     // box of all light samples, working space
  PENUMBRA_VEC4 first, step_u, step_v;  // regular grid, world: sample (i, j) = first + i step_u + j step_v;
                                        // first.w: seed of the per-pixel rotation. Other sets that pixels
                                        // move: along step_u, step_v (w: their lengths in working space), or
                                        // about the axis first.xyz of working space (step_u.w: 1, or -1 where
                                        // that space is mirrored)
  PENUMBRA_VEC4 cone;                   // spot light: axis, cosine of the half angle; w = -2: none
  PENUMBRA_VEC4 apex;                   // the light's centre, world
  PENUMBRA_VEC4 front;                  // w = 1: shines only to the side that xyz points to
  PENUMBRA_VEC4 eye;                    // the lists' projection centre, working space: the light's centre
  PENUMBRA_VEC4 window;                 // of the lists where nothing is fitted: lower corner, upper corner
  float pad;                            // working space: bound of a coordinate's rounding error
  float near;                           // what is nearer to the light has no place in the lists' frustum
  float widest;                         // largest |u| and |v| that a fitted window covers
  float farthest;                       // where no plane is fitted: no view sample is farther from the light
  // The scene's bounds, working space: their middle, and half of each side.
  PENUMBRA_VEC4 scene_middle, scene_sides[3];
};

// Places in FrameConstants, for shaders that fetch them as texels.
const PENUMBRA_UINT light_lo_texel = 13, light_hi_texel = 14, first_texel = 15, step_u_texel = 16,
                    step_v_texel = 17, cone_texel = 18, apex_texel = 19, front_texel = 20, eye_texel = 21,
                    window_texel = 22, pad_texel = 23, scene_texel = 24;

// Lists come in square tiles of lists, tile by tile; the last list holds what lies outside the frustum.
const PENUMBRA_UINT tile_side = 8, tile_lists = 64;

// A point in the lists' frustum: working space, relative to the eye, u = x / z, v = y / z. What a caster
// covers of the plane z = 1 / w through a view sample: see region.glsl.

// Counts that the device makes and the host reads.
struct Header {
  PENUMBRA_UINT group_count;   // unused by the device
  PENUMBRA_UINT list_count;    // triangles outside the blocks
  PENUMBRA_UINT resume_count;  // groups that have to go on in another dispatch
  PENUMBRA_UINT hard_count;    // groups outside all penumbrae
  PENUMBRA_UINT soft_count;    // the others
  PENUMBRA_UINT crossing;      // triangles that may reach into the light
  PENUMBRA_UINT casters;       // triangles that are left after culling
  PENUMBRA_UINT silhouettes;   // potential silhouette edges, one per triangle that has it
  // Of the view samples in the frustum, as ordered integers: minima of u and v, complements of the maxima of
  // u, v and z (0xffffffff at first).
  PENUMBRA_UINT lo[2], hi[2], farthest, padding;
  // Statistics, low and high words: pairs (caster, group) tested, pairs (triangle, view sample) evaluated,
  // pairs whose triangle covers at least one light sample.
  PENUMBRA_UINT tests[2], pairs[2], necessary[2];
};

#ifdef __cplusplus
static_assert(sizeof(FrameConstants) == 208 + 15 * 16 && offsetof(FrameConstants, pad) == 16 * pad_texel);
static_assert(offsetof(FrameConstants, light_lo) == 16 * light_lo_texel &&
              offsetof(FrameConstants, first) == 16 * first_texel &&
              offsetof(FrameConstants, cone) == 16 * cone_texel &&
              offsetof(FrameConstants, apex) == 16 * apex_texel &&
              offsetof(FrameConstants, front) == 16 * front_texel &&
              offsetof(FrameConstants, eye) == 16 * eye_texel &&
              offsetof(FrameConstants, window) == 16 * window_texel &&
              offsetof(FrameConstants, scene_middle) == 16 * scene_texel);
static_assert(sizeof(Header) == 80 && offsetof(Header, lo) == 32 && offsetof(Header, tests) == 56);
}  // namespace penumbra::sample_based_soft
#endif
#undef PENUMBRA_VEC4
#undef PENUMBRA_UINT
#endif
