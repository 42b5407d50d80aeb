// One invocation per caster: those of few texels are tested here, the rest become items.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

void add_item(uint entry, uint row, uint rows) {
  push.items.at[atomicAdd(push.progress.p.item_count, 1u)] = uvec2(entry, row << 8u | rows);
}

void main() {
  // Some drivers give each thread one contiguous part of the groups: neighbours, alike in cost, go to different parts.
  const uint strips = 64u, group = linear_group();
  const uint part = (push.groups + strips - 1u) / strips;
  const uint index = (group % strips * part + group / strips) * group_lanes + gl_LocalInvocationIndex;
  if (group / strips >= part || index >= push.count) return;
  const uint entry = push.casters.at[push.first + index];
  const Caster caster = load_caster(entry);
  const Face face = push.frame.f.faces[push.face];
  const uint grid_size = push.frame.f.grid_size;
  const Footprint f = footprint(caster, face);
  const ivec2 rows = rows_of(f, int(grid_size));
  uint pairs = 0u;
  if (rows.y - rows.x >= int(small_rows)) {
    for (int y = rows.x; y <= rows.y; y += int(item_rows)) add_item(entry, uint(y), min(item_rows, uint(rows.y + 1 - y)));
    return;
  }
  for (int y = rows.x; y <= rows.y; ++y) {
    const uvec2 range = row_range(f, face, y, grid_size);
    if (range.y - range.x > small_range) {
      add_item(entry, uint(y), 1u);
    } else {
      for (uint slot = range.x; slot < range.y; slot += 32u) test(entry, caster, slot, min(range.y - slot, 32u));
      pairs += range.y - range.x;
    }
  }
  count_pairs(pairs);
}
