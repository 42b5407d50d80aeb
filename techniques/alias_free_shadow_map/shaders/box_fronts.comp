// Boxes of the triangles at the back of the list, front_block of them each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
#include "techniques/alias_free_shadow_map/shaders/corners.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FacingPush push; };

void main() {
  const uint index = linear_group() * group_lanes + gl_LocalInvocationIndex, fronts = push.counts.at[1];
  if (index * front_block >= fronts) return;
  vec3 lo = vec3(3e38), hi = vec3(-3e38);
  for (uint i = index * front_block; i < min((index + 1u) * front_block, fronts); ++i) {
    const Caster t = load_caster(push.casters.at[push.count - 1u - i], push.light);
    lo = min(lo, min(t.a, min(t.b, t.c)));
    hi = max(hi, max(t.a, max(t.b, t.c)));
  }
  push.boxes.at[2u * index] = vec4(lo, 0.0);
  push.boxes.at[2u * index + 1u] = vec4(hi, 0.0);
}
