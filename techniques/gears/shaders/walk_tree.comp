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
// So take chunks of 16 groups from 64 places in turn, the first of them one chunk longer where it does not come out even.
uint interleaved(uint n) {
  uint chunks = (pc.groups + 15u) / 16u, chunk = n / 16u, place = chunk % 64u;
  return (place * (chunks / 64u) + min(place, chunks % 64u) + chunk / 64u) * 16u + n % 16u;
}

uint first_leaf_below(uint node) {
  for (uint d = 0u; d < DEPTH; d++) node = node < pc.first_leaf ? node * SG + 1u : node;
  return node - pc.first_leaf;
}
uint last_leaf_below(uint node) {
  for (uint d = 0u; d < DEPTH; d++) node = node < pc.first_leaf ? node * SG + SG : node;
  return node - pc.first_leaf;
}

// A stack and a queue of nodes whose children are to be visited: the first child, and a bit for each of them. They lie in
// the lanes, entry k in lane k % SG: an array at a place that varies would be written lane by lane.
const uint STACK_PARTS = (DEPTH + SG - 1u) / SG;

// Walks on from leaf `start` until `limit` loop turns; returns where to go on, or 0xffffffff when done.
uint walk(uint start, uint limit) {
  uint lane = gl_SubgroupInvocationID;
  uint stack_first[STACK_PARTS], stack_bits[STACK_PARTS];
  [[unroll]] for (uint k = 0u; k < STACK_PARTS; k++) stack_first[k] = stack_bits[k] = 0u;
  uint queue_first = 0u, queue_bits = 0u;   // above the leaves
  uint node = 0u;
  int top = -1;
  bool more = true;
  do {
    uint parents = 0u, found = 0u;
    do {
      uint first = node * SG + 1u, child = first + lane;
      bool above_leaves = first >= pc.first_leaf;
      vec4 a = texel(boxes, child * 2u), b = texel(boxes, child * 2u + 1u);
      uint rect;
      bool hit = touches(a.xyz, vec3(a.w, b.xy), rect);
      if (RESUMED) {
        hit = hit && last_leaf_below(child) >= start;
        turns += DEPTH;
      }
      uint m = ballot(hit);
      bool take = above_leaves && m != 0u, push = !above_leaves && m != 0u;
      bool mine = take && lane == parents;
      queue_first = mine ? first : queue_first;
      queue_bits = mine ? m : queue_bits;
      parents += take ? 1u : 0u;
      found += take ? uint(bitCount(m)) : 0u;
      // On with the first child of what was found, or of the last on the stack.
      top += push ? 1 : 0;
      more = top >= 0;
      uint at = uint(max(top, 0)), its_first = 0u, bits = 0u;
      [[unroll]] for (uint k = 0u; k < STACK_PARTS; k++) {
        uint f = subgroupShuffle(stack_first[k], at % SG), s = subgroupShuffle(stack_bits[k], at % SG);
        its_first = at / SG == k ? f : its_first;
        bits = at / SG == k ? s : bits;
      }
      its_first = push ? first : its_first;
      bits = push ? m : bits;
      node = its_first + uint(findLSB(more ? bits : 1u));
      bits &= bits - 1u;
      [[unroll]] for (uint k = 0u; k < STACK_PARTS; k++) {
        bool here = lane == at % SG && at / SG == k;
        stack_first[k] = here ? its_first : stack_first[k];
        stack_bits[k] = here ? bits : stack_bits[k];
      }
      top -= more && bits == 0u ? 1 : 0;
      turns++;
      if (COUNTING != 0u) nodes++;
    } while (more && found < LEAF_BATCH && parents < SG && turns < limit);

    bool full = false;
    if (found > 0u) {
      uint i = 0u, first = subgroupShuffle(queue_first, 0u), bits = subgroupShuffle(queue_bits, 0u);
      do {
        Triangles t;
        uint left;
        do {   // to the next leaf with triangles that may hide something
          left = find((first + uint(findLSB(bits)) - pc.first_leaf) * SG + lane, true, false, t);
          bits &= bits - 1u;
          bool next = bits == 0u;
          i = next && i + 1u < SG ? i + 1u : i;
          uint next_first = subgroupShuffle(queue_first, i), next_bits = subgroupShuffle(queue_bits, i);
          first = next ? next_first : first;
          bits = next ? next_bits : bits;
          turns++;
          found--;
          if (COUNTING != 0u) leaves++;
        } while (left == 0u && found > 0u);
        if (left != 0u) rasterise_found(t, left, false);
        full = all_blocked();
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

// A group of view samples, or a part of one.
struct Work {
  uint group, lanes, start;   // start: leaf to go on at
};

Work work_of(uint n) {
  Work w = Work(interleaved(n), every_lane, 0u);
  if (RESUMED) {
    uint entry = (pc.read_list * pc.capacity + n / pc.parts) * 3u;
    w = Work(pc.resume.at[entry], pc.resume.at[entry + 1u], pc.resume.at[entry + 2u]);
  }
  return w;
}

// One group. `turns` counts on from group to group; one for which too few are left goes on in the next dispatch, but
// for the `first`. Returns the leaf to go on at.
uint do_group(Work work, bool first, FrameConstants f) {
  uint next = 0xffffffffu;
  if (BEGIN)
    block_horizon(position, normal, f);
  else
    load_mask(pc.masks);
  if (LIST) do_list(pc.list, pc.list_begin, pc.list_end);
  if (WALK) {
    if (!BEGIN && COUNTING != 2u) update_open();
    bool single = (work.lanes & (work.lanes - 1u)) == 0u;
    uint limit = single ? TURN_LIMIT : min(turns + pc.split_turns, TURN_LIMIT);
    bool enough = first || turns + pc.split_turns <= TURN_LIMIT;
    if (!all_blocked()) {
      next = work.start;
      if (enough) next = walk(work.start, limit);
    }
  }
  store_mask(pc.masks);
  store_visibility(pc.visibility);
  return next;
}

// Writes down where to go on: each lane of that with something `left`.
void leave(Work left) {
  bool mine = left.start != 0xffffffffu;
  uint lanes = ballot(mine), at = 0u;
  if (lanes == 0u) return;
  if (gl_SubgroupInvocationID == 0u) at = atomicAdd(pc.header.h.resume_count, uint(bitCount(lanes)));
  at = subgroupShuffle(at, 0u) + uint(bitCount(lanes & ((1u << gl_SubgroupInvocationID) - 1u)));
  uint entry = ((1u - pc.read_list) * pc.capacity + at) * 3u;
  if (mine) {
    pc.resume.at[entry] = left.group;
    pc.resume.at[entry + 1u] = left.lanes;
    pc.resume.at[entry + 2u] = left.start;
  }
}

void main() {
  uint n = linear_group() * pc.groups_each, end = min(n + pc.groups_each, pc.work_groups);
  if (n >= end) return;
  FrameConstants f = frame;
  Work left = Work(0u, 0u, 0xffffffffu), next = work_of(n);
  Fetched fetched = fetch_group(min(next.group, pc.groups - 1u), next.lanes, pc.slots, pc.masks);
  for (uint k = 0u; k < min(SG, pc.groups_each); k++) {   // a workgroup costs more to launch than a turn
    Work work = next;
    begin_group(fetched, f, pc.light_samples);
    bool some = n < end && (RESUMED || work.group < pc.groups);
    if (RESUMED) {
      // A group that costs much has view samples far apart, so that what it walks is wide: it goes on as two, of
      // neighbours each.
      uint beyond = pc.parts == 2u ? beyond_gap(work.lanes) : 0u;
      work.lanes = n % pc.parts == 0u ? work.lanes & ~beyond : beyond;
      some = some && work.lanes != 0u;
      begin_group(fetch_group(work.group, work.lanes, pc.slots, pc.masks), f, pc.light_samples);
    }
    n++;
    next = work_of(min(n, end - 1u));
    fetched = fetch_group(min(next.group, pc.groups - 1u), next.lanes, pc.slots, pc.masks);
    if (some) {
      work.start = do_group(work, k == 0u, f);
      bool mine = gl_SubgroupInvocationID == k;
      left.group = mine ? work.group : left.group;
      left.lanes = mine ? work.lanes : left.lanes;
      left.start = mine ? work.start : left.start;
    }
    turns++;
  }
  leave(left);
  add_statistics(pc.header);
}
