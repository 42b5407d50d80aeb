// The sides of a wedge as seen from its inside, and its cap at infinity: what is drawn is what lies behind all of the
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
  const uint triangle = vertex / 3, corner = vertex % 3;
  const vec4 a = push.wedges.at[wedge].edge[0], b = push.wedges.at[wedge].edge[1];
  const uint n = uint(b.w);
  edge_a = a, edge_b = b.xyz;
  gl_Position = vec4(0);
  if (n == WHOLE_PICTURE) {
    // Once each way about: one of the two is culled.
    const float x = corner == 1 ? 3.0 : -1.0, y = corner == 2 ? 3.0 : -1.0;
    if (triangle < 2) gl_Position = triangle == 0 ? vec4(x, y, 0, 1) : vec4(y, x, 0, 1);
    return;
  }
  if (triangle < 2 * MOST_DIRECTIONS) {
    const uint k = triangle / 2, next = k + 1 < n ? k + 1 : 0;
    if (k >= n) return;
    const vec4 d = push.wedges.at[wedge].ring[k], e = push.wedges.at[wedge].ring[next];
    const bool second = (triangle & 1) != 0;
    if (second && d.w == e.w) return;
    const uint apex = uint(second && corner == 2 ? e.w : d.w);
    const bool at_apex = corner == 0 || (second && corner == 2);
    const vec3 direction = !second && corner == 1 ? d.xyz : e.xyz;
    gl_Position = push.clip_from_world *
                  (at_apex ? vec4(push.wedges.at[wedge].apex[apex].xyz, 1.0) : vec4(direction, 0.0));
    return;
  }
  const uint j = triangle - 2 * MOST_DIRECTIONS + 1;
  if (j + 1 >= n) return;
  const uint at = corner == 0 ? 0 : corner == 1 ? j + 1 : j;
  gl_Position = push.clip_from_world * vec4(push.wedges.at[wedge].ring[at].xyz, 0.0);
}
