// assignment: clusters. A group of view samples walks the box tree together, collects leaves, rasterises their
// triangles, and skips what can hide no light sample that is still open.
//
// The walk takes children in ascending order, so leaves too: where a group stands is one number, the next leaf.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "techniques/gears/shaders/walk.glsl"

layout(set = 0, binding = 4) uniform Texels boxes;   // 2 texels per node
layout(set = 0, binding = 5) uniform FrameBlock { FrameConstants frame; };
layout(push_constant) uniform Push { WalkTreeConstants pc; };

const uint DEPTH = 12u;

// Groups that cost much are neighbours; a device that deals its threads contiguous work would leave them all to one.
// So take chunks of 16 groups from 64 places in turn.
uint interleaved(uint n) {
  uint columns = ((pc.groups + 15u) / 16u + 63u) / 64u, chunk = n / 16u;
  return ((chunk % 64u) * columns + chunk / 64u) * 16u + n % 16u;
}

uint first_leaf_below(uint node) {
  for (uint d = 0u; d < DEPTH; d++) node = node < pc.first_leaf ? node * SG + 1u : node;
  return node - pc.first_leaf;
}
uint last_leaf_below(uint node) {
  for (uint d = 0u; d < DEPTH; d++) node = node < pc.first_leaf ? node * SG + SG : node;
  return node - pc.first_leaf;
}

// Walks on from leaf `start` until `limit` loop turns; returns where to go on, or 0xffffffff when done.
uint walk(uint start, uint limit) {
  uint first_child[DEPTH], pending[DEPTH];              // per level: a bit for each child to visit
  uint leaf_first[LEAF_BATCH + 1u], leaf_mask[LEAF_BATCH + 1u];   // leaves to rasterise: a bit per child
  uint node = 0u;
  int top = -1;
  bool more = true;
  do {
    uint parents = 0u, found = 0u;
    do {
      uint first = node * SG + 1u, child = first + gl_SubgroupInvocationID;
      bool above_leaves = first >= pc.first_leaf;
      vec4 a = texel(boxes, child * 2u), b = texel(boxes, child * 2u + 1u);
      uint rect;
      bool hit = touches(a.xyz, vec3(a.w, b.xy), rect);
      if (RESUMED) {
        hit = hit && last_leaf_below(child) >= start;
        turns += DEPTH;
      }
      uint m = ballot(hit);
      leaf_first[parents] = first;
      leaf_mask[parents] = m;
      bool take = above_leaves && m != 0u, push = !above_leaves && m != 0u;
      parents += take ? 1u : 0u;
      found += take ? uint(bitCount(m)) : 0u;
      top += push ? 1 : 0;
      int at = max(top, 0);
      first_child[at] = push ? first : first_child[at];
      uint bits = push ? m : pending[at];
      more = top >= 0;
      node = first_child[at] + uint(findLSB(more ? bits : 1u));
      bits &= bits - 1u;
      pending[at] = bits;
      top -= more && bits == 0u ? 1 : 0;
      turns++;
      if (COUNTING != 0u) nodes++;
    } while (more && found < LEAF_BATCH && turns < limit);

    bool full = false;
    if (found > 0u) {
      uint i = 0u, left = leaf_mask[0];
      do {
        uint leaf = leaf_first[i] + uint(findLSB(left)) - pc.first_leaf;
        rasterise_slots(leaf * SG + gl_SubgroupInvocationID, true, false);
        left &= left - 1u;
        i += left == 0u ? 1u : 0u;
        left = left == 0u ? leaf_mask[i] : left;
        turns++;
        found--;
        full = all_blocked();
        if (COUNTING != 0u) leaves++;
      } while (found > 0u && !full);
    }
    more = more && !full;
    if (COUNTING != 2u && more) update_open();
  } while (more && turns < limit);
  return more ? first_leaf_below(node) : 0xffffffffu;
}

// Those of `lanes` beyond the widest gap along the longest axis of their view samples; 0 where all are in one place.
uint beyond_gap(uint lanes) {
  vec3 extent = group_hi - group_lo;
  bool x = extent.x >= extent.y && extent.x >= extent.z, y = !x && extent.y >= extent.z;
  float mine = x ? p.x : y ? p.y : p.z, next = 1e30;
  for (uint l = 0u; l < SG; l++) {
    float other = subgroupShuffle(mine, l);   // lanes that do not take part stand in for one that does
    next = other > mine ? lower(next, other) : next;
  }
  float gap = next < 1e30 ? next - mine : 0.0, widest = highest(gap);
  float end = lowest(gap == widest ? mine : 1e30);
  uint beyond = ballot(mine > end) & lanes;
  return widest > 0.0 ? beyond : 0u;
}

void go_on(uint at, uint group, uint lanes, uint next) {
  uint entry = ((1u - pc.read_list) * pc.capacity + at) * 3u;
  pc.resume.at[entry] = group;
  pc.resume.at[entry + 1u] = lanes;
  pc.resume.at[entry + 2u] = next;
}

// Writes down where to go on. A group that costs much has view samples far apart, so that what it walks is wide: it goes
// on as two, of neighbours each.
void leave(uint group, uint lanes, uint next) {
  uint beyond = beyond_gap(lanes);
  if (gl_SubgroupInvocationID != 0u) return;
  if (beyond != 0u && pc.groups + atomicAdd(pc.header.h.split_count, 1u) < pc.capacity) {
    uint at = atomicAdd(pc.header.h.resume_count, 2u);
    go_on(at, group, lanes & ~beyond, next);
    go_on(at + 1u, group, beyond, next);
  } else {
    go_on(atomicAdd(pc.header.h.resume_count, 1u), group, lanes, next);
  }
}

// One group. `turns` counts on from group to group; one for which too few are left goes on in the next dispatch, but
// for the `first`.
void do_group(uint n, bool first, FrameConstants f) {
  uint g = RESUMED ? n : interleaved(n);
  uint lanes = every_lane, start = 0u;
  if (RESUMED) {
    uint entry = (pc.read_list * pc.capacity + n) * 3u;
    g = pc.resume.at[entry];
    lanes = pc.resume.at[entry + 1u];
    start = pc.resume.at[entry + 2u];
  }
  if (!RESUMED && g >= pc.groups) return;
  begin_group(g, lanes, f, pc.slots, pc.light_samples);
  if (BEGIN)
    block_horizon(texel(position_texels, pixel).xyz, texel(normal_texels, pixel).xyz, f);
  else
    load_mask(pc.masks);
  if (LIST) do_list(pc.list, pc.list_begin, pc.list_end);
  if (WALK) {
    if (!BEGIN && COUNTING != 2u) update_open();
    uint next = 0xffffffffu;
    bool single = (lanes & (lanes - 1u)) == 0u;
    uint limit = single ? TURN_LIMIT : min(turns + pc.split_turns, TURN_LIMIT);
    bool enough = first || turns + pc.split_turns <= TURN_LIMIT;
    if (!all_blocked()) {
      next = start;
      if (enough) next = walk(start, limit);
    }
    if (next != 0xffffffffu) leave(g, lanes, next);
  }
  store_mask(pc.masks);
  store_visibility(pc.visibility);
}

void main() {
  uint n = linear_group() * pc.groups_each, end = min(n + pc.groups_each, pc.work_groups);
  if (n >= end) return;
  FrameConstants f = frame;
  bool first = true;
  do {   // a workgroup costs more to launch than a turn
    do_group(n, first, f);
    first = false;
    n++;
    turns++;
  } while (n < end);
  add_statistics(pc.header);
}
