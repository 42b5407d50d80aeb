// What GLSL and C++ share: constants of one frame, and the layout of buffers.
#ifndef PENUMBRA_GEARS_SHARED_H
#define PENUMBRA_GEARS_SHARED_H
#include "techniques/common/shaders/light_basis.h"
#ifdef __cplusplus
namespace penumbra::gears {
#define PENUMBRA_VEC4 Vec4f
#define PENUMBRA_UINT uint32_t
#define PENUMBRA_ADDRESS(type) uint64_t
#else
#define PENUMBRA_VEC4 vec4
#define PENUMBRA_UINT uint
#define PENUMBRA_ADDRESS(type) type
#endif

// Working space (see LightBasis): for a regular grid of light samples its unit is one light sample, sample
// (i, j) lies at (i, j, 0) and receivers have z > 0. For any other light it is the world, moved.
struct FrameConstants {
  LightBasis light;
  PENUMBRA_VEC4 light_lo, light_hi;     // box of all light samples, working space; w = 0: of directions
  PENUMBRA_VEC4 first, step_u, step_v;  // regular grid, world: sample (i, j) = first + i step_u + j step_v;
                                        // first.w: seed of the per-pixel rotation
  PENUMBRA_VEC4 camera_x, camera_y,
      camera_z;              // grid camera C: rows for working - camera_eye; its corners of the light
  PENUMBRA_VEC4 camera_eye;  // w = 1: perspective, 0: parallel
  PENUMBRA_VEC4 cone;        // spot light: axis, cosine of the half angle; w = -2: none
  PENUMBRA_VEC4 apex;        // the light's centre, world
  PENUMBRA_VEC4 front;       // w = 1: shines only to the side that xyz points to
  float pad;                 // working space: bound of a coordinate's rounding error
  float near;                // grid camera: what is nearer than this has no place on the grid
  float grid_unit;           // grid camera: typical size of a coordinate on its image plane
  PENUMBRA_UINT paper_extrusion;
};

// Places in FrameConstants, for shaders that fetch them as texels.
const PENUMBRA_UINT camera_texel = 18, pad_texel = 25;  // from camera_texel on: camera_x, _y, _z, _eye

// Counts that the device makes and the host reads.
struct Header {
  PENUMBRA_UINT group_count;   // groups of view samples
  PENUMBRA_UINT list_count;    // triangles outside the tree or the cells
  PENUMBRA_UINT resume_count;  // groups, or parts of them, that have to go on in another dispatch
  PENUMBRA_UINT large_count;   // triangles that touch many cells
  PENUMBRA_UINT farthest;      // float bits: largest z of a view sample before the grid camera
  PENUMBRA_UINT padding[3];
  // Statistics, low and high words: nodes and leaves visited, pairs (triangle, view sample) rasterised, pairs
  // whose triangle covers at least one light sample.
  PENUMBRA_UINT nodes[2], leaves[2], pairs[2], necessary[2];
  float grid_lo[2], grid_scale[2];  // cell = (image plane - lo) * scale
};

#ifdef __cplusplus
static_assert(sizeof(FrameConstants) == 208 + 12 * 16 + 16);
static_assert(offsetof(FrameConstants, camera_x) == 16 * camera_texel &&
              offsetof(FrameConstants, camera_eye) == 16 * (camera_texel + 3) &&
              offsetof(FrameConstants, pad) == 16 * pad_texel);
static_assert(sizeof(Header) == 80 && offsetof(Header, nodes) == 32 && offsetof(Header, grid_lo) == 64);
}  // namespace penumbra::gears
#endif
#undef PENUMBRA_VEC4
#undef PENUMBRA_UINT
#undef PENUMBRA_ADDRESS
#endif
