// Triangles of closed meshes that face the light against the few view samples that lie on a closed mesh's inside.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

void main() {
  const uint t = linear_group() * group_lanes + gl_LocalInvocationIndex;
  if (t >= push.count) return;
  const Caster caster = load_caster(t);
  if (!casts(t, caster)) return;
  const uint count = min(push.progress.p.inner_count, most_inner);
  for (uint i = 0u; i < count; ++i) test(t, caster, push.progress.p.inner[i]);
  count_pairs(count);
}
