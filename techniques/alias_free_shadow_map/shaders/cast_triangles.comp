// Casters of few texels are tested here, the rest become items.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

void add_item(uint t, uint row, uint rows) {
  push.items.at[atomicAdd(push.progress.p.item_count, 1u)] = uvec2(t, row << 8u | rows);
}

void cast_one(uint t, const View view) {
  const Caster caster = load_caster(t, view.light);
  const Footprint f = footprint(caster, view);
  const ivec2 rows = rows_of(f, int(view.grid_size));
  if (rows.y - rows.x >= int(small_rows)) {
    for (int y = rows.x; y <= rows.y; y += int(item_rows)) add_item(t, uint(y), min(item_rows, uint(rows.y + 1 - y)));
    return;
  }
  uint pairs = 0u;
  for (int y = rows.x; y <= rows.y; ++y) {
    const uvec2 range = row_range(f, view, y);
    if (range.y - range.x > small_range) {
      add_item(t, uint(y), 1u);
    } else {
      test(t, caster, view.light, range.x, range.y);
      pairs += range.y - range.x;
    }
  }
  count_pairs(pairs);
}

void main() {
  // Some drivers give each thread one contiguous part of the groups: neighbours, alike in cost, go to different parts.
  const uint strips = 64u, group = linear_group();
  const uint part = (push.groups + strips - 1u) / strips;
  if (group / strips >= part) return;
  const uint first = (group % strips * part + group / strips) * group_lanes * triangles_per_lane;
  const View view = load_view();
  for (uint i = 0u; i < triangles_per_lane; ++i) {
    const uint index = first + i * group_lanes + gl_LocalInvocationIndex;
    if (index >= push.count) break;
    cast_one(push.casters.at[push.first + index], view);
  }
}
