// Parameters of view_samples.comp, for GLSL and C++.
#ifndef PENUMBRA_VIEW_SAMPLES_PARAMS_H
#define PENUMBRA_VIEW_SAMPLES_PARAMS_H
#include "gpu/shaders/shared.h"

#ifdef __cplusplus
namespace penumbra::gpu::shared {
#endif

struct ViewSamplesParams {
  PENUMBRA_ADDRESS(Vec3Array) vertex_positions;
  PENUMBRA_ADDRESS(Vec3Array) vertex_normals;
  PENUMBRA_ADDRESS(UintArray) indices;
  PENUMBRA_ADDRESS(UintArray) triangle;
  PENUMBRA_ADDRESS(Vec2Array) barycentrics;
  PENUMBRA_ADDRESS(Vec4Array) position;
  PENUMBRA_ADDRESS(Vec4Array) origin;
  PENUMBRA_ADDRESS(Vec4Array) geometric_normal;
  PENUMBRA_ADDRESS(Vec4Array) shading_normal;
  vec3 eye;
  vec3 corner;  // direction through the picture's upper left corner, forward component 1
  vec3 step_x;  // what one pixel to the right adds to the direction
  vec3 step_y;  // what one row down adds
  vec3 forward;
  float offset;  // eps of P' = P + eps Ng, scene units
  uint width;
  uint pixels;
};

#ifdef __cplusplus
static_assert(sizeof(ViewSamplesParams) == 144 && offsetof(ViewSamplesParams, eye) == 72);
}  // namespace penumbra::gpu::shared
#endif
#endif
