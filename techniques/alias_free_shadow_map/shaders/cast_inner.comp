// Triangles of closed meshes that face the light against the few view samples that lie on a closed mesh's inside: an
// invocation takes a block of triangles, and goes through them for view samples whose way to the light meets its box.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

// Whether the way from p to the light may meet a triangle in the box, rounding included.
bool may_meet(vec3 p, vec4 light, vec3 lo, vec3 hi) {
  const vec3 d = light.xyz - p * light.w;
  const vec3 slack = 2e-5 * (abs(lo) + abs(hi) + abs(p) + (PARALLEL ? vec3(0.0) : abs(light.xyz)));
  const vec3 below = lo - slack - p, above = hi + slack - p;
  float enter = 0.0, leave = PARALLEL ? 3e38 : 1.0;
  [[unroll]] for (int k = 0; k < 3; ++k) {
    const bool still = abs(d[k]) < 1e-20;
    const float a = below[k] / d[k], b = above[k] / d[k];
    enter = still ? (below[k] <= 0.0 && above[k] >= 0.0 ? enter : 3e38) : max(enter, min(a, b));
    leave = still ? leave : min(leave, max(a, b));
  }
  return enter <= leave;
}

void main() {
  const uint index = linear_group() * group_lanes + gl_LocalInvocationIndex;
  if (index * front_block >= push.count) return;
  const vec4 light = block.f.light;
  const vec3 lo = push.boxes.at[2u * index].xyz, hi = push.boxes.at[2u * index + 1u].xyz;
  const uint inner = min(push.progress.p.inner_count, most_inner);
  uint pairs = 0u;
  for (uint k = 0u; k < inner; ++k) {
    const uint slot = push.progress.p.inner[k];
    const uvec4 s = texelFetch(lists, ivec2(slot & 8191u, slot >> 13u), 0);
    const bool near = may_meet(uintBitsToFloat(s.xyz), light, lo, hi);
    const uint end = near ? min((index + 1u) * front_block, push.count) : 0u;
    for (uint i = index * front_block; i < end; ++i) {
      const uint t = push.casters.at[push.first + push.count - 1u - i];
      test(t, load_caster(t, light), light, slot, slot + 1u);
      ++pairs;
    }
  }
  count_pairs(pairs);
}
