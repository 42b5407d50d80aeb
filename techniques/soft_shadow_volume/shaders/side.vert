// Sides of the hard shadow's volumes: a quad from each silhouette edge to infinity, away from the light's centre.
// Counter-clockwise seen from outside for edges of positive weight.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
layout(push_constant, scalar) uniform Push { DrawPush push; };
layout(location = 0) flat out vec4 edge_a;  // w: weight
layout(location = 1) flat out vec3 edge_b;
invariant gl_Position;

void main() {
  const uint corner = uint(gl_VertexIndex) % 6;
  const Silhouette s = push.silhouettes.at[uint(gl_VertexIndex) / 6];
  const vec3 a = push.positions.at[s.vertex[0]], b = push.positions.at[s.vertex[1]];
  edge_a = vec4(a, float(s.weight)), edge_b = b;
  const vec3 at = corner == 0 || corner == 3 || corner == 5 ? a : b;
  const bool far = corner == 2 || corner >= 4;
  gl_Position = push.clip_from_world * (far ? vec4(at - push.center.xyz, 0.0) : vec4(at, 1.0));
}
