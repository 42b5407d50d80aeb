// Crowded triangles as items, which cast_items.comp works off.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

void add_item(uint t, uint row, uint rows) {
  push.items.at[atomicAdd(push.progress.p.item_count, 1u)] = uvec2(t, row << 8u | rows);
}

void main() {
  const uint index = linear_group() * group_lanes + gl_LocalInvocationIndex;
  if (index >= push.count) return;
  const uvec2 crowded = push.crowded.at[push.first + index];
  const View view = load_view();
  const ivec2 rows = rows_of(footprint(load_caster(crowded.x, view.light), view), int(view.grid_size));
  if (crowded.y == all_rows) {
    for (int y = rows.x; y <= rows.y; y += int(item_rows))
      add_item(crowded.x, uint(y), min(item_rows, uint(rows.y + 1 - y)));
    return;
  }
  for (uint bits = crowded.y; bits != 0u; bits &= bits - 1u) add_item(crowded.x, uint(rows.x + findLSB(bits)), 1u);
}
