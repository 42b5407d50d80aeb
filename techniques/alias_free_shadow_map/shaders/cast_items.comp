// item_rows invocations per item: one per row, or, for an item of one row, side by side along that row.
//
// lavapipe silently ends loops after 65,535 turns of an invocation: a dispatch does at most TURNS view samples of each
// range, from push.first on, and says how long the longest range is; the host dispatches until all are done.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"
layout(constant_id = 1) const uint TURNS = 32768;

void main() {
  const uint invocation = linear_group() * group_lanes + gl_LocalInvocationIndex;
  const uint index = invocation / item_rows, lane = invocation % item_rows;
  if (index >= push.count) return;
  const uvec2 item = push.items.at[index];
  const uint rows = item.y & 255u;
  const bool single = rows == 1u;
  if (!single && lane >= rows) return;
  const View view = load_view();
  const Caster caster = load_caster(item.x, view.light);
  const Footprint f = footprint(caster, view);
  const uvec2 range = row_range(f, view, int((item.y >> 8u) + (single ? 0u : lane)));
  // Of one row: a contiguous part for each invocation.
  const uint part = single ? (range.y - range.x + item_rows - 1u) / item_rows : range.y - range.x;
  const uint begin = min(range.x + (single ? lane * part : 0u), range.y), length = min(part, range.y - begin);
  if (push.first == 0u && length > TURNS) atomicMax(push.progress.p.longest, length);
  const uint turns = length > push.first ? min(length - push.first, TURNS) : 0u;
  test(item.x, caster, view.light, begin + push.first, begin + push.first + turns);
  count_pairs(turns);
}
