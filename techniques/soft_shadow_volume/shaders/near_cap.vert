// Casters that turn their back to the light and may be cut by the near plane: what is before that plane is never seen,
// but a ray from the eye passes it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
layout(push_constant, scalar) uniform Push { DrawPush push; };
layout(location = 0) flat out vec3 corner;
layout(location = 1) flat out vec3 normal;
layout(location = 2) flat out uint triangle;
invariant gl_Position;

void main() {
  triangle = push.caps.near_cap[gl_VertexIndex];
  const vec3 a = push.positions.at[push.indices.at[3 * triangle]];
  const vec3 b = push.positions.at[push.indices.at[3 * triangle + 1]];
  const vec3 c = push.positions.at[push.indices.at[3 * triangle + 2]];
  const uint i = uint(gl_VertexIndex) % 3;
  corner = a, normal = cross(b - a, c - a);
  gl_Position = push.clip_from_world * vec4(i == 0 ? a : i == 1 ? b : c, 1.0);
}
