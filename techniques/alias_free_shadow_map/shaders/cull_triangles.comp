// Which triangles cast: those that do are listed, so that the lanes of cast_triangles.comp all have work.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

void main() {
  const uint first = linear_group() * group_lanes * triangles_per_lane + gl_LocalInvocationIndex;
  for (uint i = 0u; i < triangles_per_lane; ++i) {
    const uint t = first + i * group_lanes;
    if (t >= push.count) break;
    const uint entry = entry_of(t);
    if (casts(entry, load_caster(entry))) push.casters.at[atomicAdd(push.progress.p.caster_count, 1u)] = entry;
  }
}
