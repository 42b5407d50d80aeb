// Buffers of the room, and the light as its kernels see it.
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/light_emission.glsl"
#include "techniques/common/shaders/ordered_float.glsl"
layout(buffer_reference) buffer FrameRef;
layout(buffer_reference) buffer BoundsArray;
layout(buffer_reference) buffer ItemArray;
layout(buffer_reference) buffer ProgressRef;
#include "techniques/alias_free_shadow_map/shaders/shared.h"
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer FrameRef { LightView f; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer BoundsArray { SampleBounds at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer ItemArray { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ProgressRef { Progress p; };

// The light is at infinity. A constant of the pipeline and no question to the frame's buffer: lavapipe (Mesa 22.3.6)
// answers `light.w == 0.0` wrongly in the kernels that test triangles.
layout(constant_id = 3) const bool PARALLEL = false;

// (u, v, depth) of q in a face.
vec3 project(const Face face, vec3 q) {
  const float depth = dot(face.forward.xyz, q);
  return vec3(vec2(dot(face.right.xyz, q), dot(face.down.xyz, q)) / (PARALLEL ? 1.0 : depth), depth);
}

// The face of a cube about the light that q is seen through: 2 axis + (negative side ? 1 : 0).
uint cube_face(vec3 q) {
  const vec3 a = abs(q);
  const uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
  return 2u * axis + (q[axis] < 0.0 ? 1u : 0u);
}
