// The sides of a wedge as seen from its inside, and its far cap: what is drawn is what lies behind all of the
// wedge's points at a pixel, once.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
layout(push_constant, scalar) uniform Push { WedgePush push; };
layout(location = 0) flat out vec4 edge_a;  // w: weight
layout(location = 1) flat out vec3 edge_b;
invariant gl_Position;

void main() {
  const uint wedge = uint(gl_VertexIndex) / WEDGE_VERTICES, vertex = uint(gl_VertexIndex) % WEDGE_VERTICES;
  const vec4 a = push.wedges.at[wedge].edge[0], b = push.wedges.at[wedge].edge[1];
  edge_a = a, edge_b = b.xyz;
  const bool apex = vertex < 2;
  const vec3 at = apex ? push.wedges.at[wedge].apex[vertex].xyz : push.wedges.at[wedge].ring[vertex - 2].xyz;
  const float far = push.wedges.at[wedge].apex[0].w;
  const vec4 corner = vec4(vertex == 1 ? 3.0 : -1.0, vertex == 2 ? 3.0 : -1.0, 0.0, 1.0);
  gl_Position = uint(b.w) == WHOLE_PICTURE ? corner : push.clip_from_world * vec4(at, apex ? 1.0 : far);
}
