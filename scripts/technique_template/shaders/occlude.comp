// One invocation tests the triangles of this dispatch against 32 light samples of a pixel: one word of its mask.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "shared.h"
#include "techniques/common/shaders/light_emission.glsl"
layout(local_size_x = group_lanes) in;
layout(push_constant, scalar) uniform Push { OccludePush push; };

// Whether the open segment from the origin of coordinates along d (to t = 1, or without end) meets the triangle. The same two
// corners give the same product, negated, in both triangles of an edge: nothing passes between them.
bool meets(vec3 a, vec3 b, vec3 c, vec3 d, bool endless) {
  precise const float u = dot(cross(b, c), d), v = dot(cross(c, a), d), w = dot(cross(a, b), d);
  if (!((u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0))) return false;
  const vec3 n = cross(b - a, c - a);
  const float height = dot(n, a), slope = dot(n, d);
  return slope != 0.0 && height / slope > 0.0 && (endless || height / slope < 1.0);
}

vec3 corner(uint triangle, uint k) { return push.positions.at[push.indices.at[3u * triangle + k]]; }

void main() {
  const uint index = linear_invocation();
  if (index >= push.pixels * push.words) return;
  const uint pixel = index / push.words, sample_0 = 32u * (index % push.words);
  const bool first_dispatch = push.first == 0u;
  if (push.triangle.at[pixel] == 0xffffffffu) {
    if (first_dispatch) push.mask.at[index] = 0u;
    return;
  }
  const vec3 p = push.position.at[pixel].xyz, n = push.normal.at[pixel].xyz, from = push.origin.at[pixel].xyz;
  uint blocked = first_dispatch ? 0u : push.mask.at[index];
  for (uint i = 0u; i < 32u && sample_0 + i < push.samples; ++i) {
    const vec4 light = push.points.at[sample_0 + i];
    bool dark = (blocked >> i & 1u) != 0u || !may_be_lit(p, n, light, push.light.values.emission);
    const vec3 d = light.xyz - from * light.w;
    for (uint t = push.first; t < push.end && !dark; ++t)
      dark = meets(corner(t, 0u) - from, corner(t, 1u) - from, corner(t, 2u) - from, d, light.w < 0.5);
    blocked |= dark ? 1u << i : 0u;
  }
  push.mask.at[index] = blocked;
}
