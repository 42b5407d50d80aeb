// Sides of the hard shadow's volumes: a quad from each silhouette edge away from the light's centre, to infinity or to
// a plane that bounds the scene.
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
  const int axis = int(push.center.w);
  precise const vec3 away = at - push.center.xyz;
  precise const vec3 end = at + (push.end - at[max(axis, 0)]) / away[max(axis, 0)] * away;
  gl_Position = push.clip_from_world * (!far ? vec4(at, 1.0) : axis < 0 ? vec4(away, 0.0) : vec4(end, 1.0));
}
