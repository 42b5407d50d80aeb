// A vertex of the volumes: one of the mesh, or the same moved away from the light to infinity (w = 0), or the apex.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/stencil_shadow_volume/shaders/buffers.glsl"
layout(push_constant, scalar) uniform Push { VolumePush push; };
// Near caps must get exactly the depths of the surfaces that they lie on (view_samples.vert has the same expression).
invariant gl_Position;

void main() {
  const uint v = uint(gl_VertexIndex), n = push.vertex_count;
  const bool far = v >= n;
  if (v >= 2 * n) {
    gl_Position = push.clip_from_world * vec4(push.apex.xyz, 0.0);
    return;
  }
  const vec3 position = push.positions.at[far ? v - n : v];
  if (far)
    gl_Position = push.clip_from_world * vec4(push.light.w * position - push.light.xyz, 0.0);
  else
    gl_Position = push.clip_from_world * vec4(position, 1.0);
}
