// Triangles of closed meshes that face the light against the few view samples that lie on a closed mesh's inside.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

void main() {
  const uint count = min(push.progress.p.inner_count, most_inner);
  const uint first = linear_group() * group_lanes * triangles_per_lane + gl_LocalInvocationIndex;
  uint pairs = 0u;
  for (uint i = 0u; i < triangles_per_lane; ++i) {
    const uint t = first + i * group_lanes;
    if (t >= push.count) break;
    const uint entry = entry_of(t);
    const Caster caster = load_caster(entry);
    if (casts(entry, caster)) {
      for (uint k = 0u; k < count; ++k) test(entry, caster, push.progress.p.inner[k], 1u);
      pairs += count;
    }
  }
  count_pairs(pairs);
}
