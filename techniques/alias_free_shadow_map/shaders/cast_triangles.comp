// Casters of few texels are tested here, the rest is listed as crowded: no atomics and no stores of items among the tests, which
// every lane would run through.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

shared uint group_crowded, first_crowded;

// What is left to do: as CastPush::crowded.
uint cast_one(uint t, const View view) {
  const Caster caster = load_caster(t, view.light);
  const Footprint f = footprint(caster, view);
  ivec2 rows = rows_of(f, int(view.grid_size));
  const bool idle = hides_nothing(caster, block.f.sample_lo.xyz, block.f.sample_hi.xyz);
  const bool large = !idle && rows.y - rows.x >= int(small_rows);
  if (idle || large) rows.y = rows.x - 1;
  uint left = large ? all_rows : 0u, pairs = 0u;
  for (int y = rows.x; y <= rows.y; ++y) {
    uvec2 range = row_range(f, view, y);
    const bool crowded = range.y - range.x > small_range;
    left |= crowded ? 1u << uint(y - rows.x) : 0u;
    range.y = crowded ? range.x : range.y;
    test(t, caster, view.light, range.x, range.y);
    pairs += range.y - range.x;
  }
  count_pairs(pairs);
  return left;
}

void main() {
  if (gl_LocalInvocationIndex == 0u) group_crowded = 0u;
  // Some drivers give each thread one contiguous part of the groups: neighbours, alike in cost, go to different parts.
  const uint strips = 64u, group = linear_group();
  const uint part = (push.groups + strips - 1u) / strips;
  const uint first = (group % strips * part + group / strips) * group_lanes * triangles_per_lane;
  const uint end = group / strips < part ? push.count : 0u;
  const View view = load_view();
  uint left[triangles_per_lane], crowded = 0u;
  for (uint i = 0u; i < triangles_per_lane; ++i) {
    const uint index = first + i * group_lanes + gl_LocalInvocationIndex;
    if (index >= end) break;
    left[i] = cast_one(push.casters.at[push.first + index], view);
    crowded |= left[i] != 0u ? 1u << i : 0u;
  }
  barrier();
  uint place = atomicAdd(group_crowded, uint(bitCount(crowded)));
  barrier();
  if (gl_LocalInvocationIndex == 0u) first_crowded = atomicAdd(push.progress.p.crowded_count, group_crowded);
  barrier();
  place += first_crowded;
  for (uint bits = crowded; bits != 0u; bits &= bits - 1u) {
    const uint i = uint(findLSB(bits)) % triangles_per_lane;   // lanes without bits run through once
    const uint t = push.casters.at[push.first + first + i * group_lanes + gl_LocalInvocationIndex];
    push.crowded.at[place++] = uvec2(t, left[i]);
  }
}
