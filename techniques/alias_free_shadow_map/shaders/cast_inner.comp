// Triangles of closed meshes that face the light against the few view samples that lie on a closed mesh's inside.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

void main() {
  const uint count = min(push.progress.p.inner_count, most_inner);
  const vec4 light = push.frame.f.light;
  const uint first = linear_group() * group_lanes * triangles_per_lane + gl_LocalInvocationIndex;
  uint pairs = 0u;
  for (uint i = 0u; i < triangles_per_lane; ++i) {
    const uint index = first + i * group_lanes;
    if (index >= push.count) break;
    const uint t = push.casters.at[push.first + index];
    const Caster caster = load_caster(t, light);
    for (uint k = 0u; k < count; ++k) {
      const uint slot = push.progress.p.inner[k];
      test(t, caster, light, slot, slot + 1u);
    }
    pairs += count;
  }
  count_pairs(pairs);
}
