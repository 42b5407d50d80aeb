// What the walk over the tree and the walk over the cells share: one subgroup does one group of SG view samples; its
// lanes are boxes, then triangles, then view samples.
//
// lavapipe silently ends loops after 65,535 turns of an invocation, all its loops together: every loop counts `turns`,
// and a group that nears TURN_LIMIT writes down where it is and goes on in another dispatch.
#include "techniques/gears/shaders/frame.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 6) const bool RESUMED = false;
layout(constant_id = 7) const uint LEAF_BATCH = 8;       // leaves collected before their triangles are rasterised
layout(constant_id = 8) const uint TURN_LIMIT = 20000;
layout(constant_id = 9) const uint COUNTING = 0;         // 1: statistics of this walk; 2: and no pair is skipped
layout(constant_id = 10) const bool BEGIN = true;        // this dispatch begins the masks,
layout(constant_id = 11) const bool LIST = true;         // does a part of the list,
layout(constant_id = 13) const uint SAMPLES_SEEN = 0;    // not 0: visibility is written too, from so many light samples
layout(constant_id = 12) const bool WALK = true;         // walks the tree or the cells
#include "techniques/common/shaders/subgroup.glsl"
#include "techniques/common/shaders/texels.glsl"
#include "techniques/common/shaders/edge_half_spaces.glsl"

layout(set = 0, binding = 0) uniform Texels origin_texels;   // per pixel: P' (w = 0: no view sample),
layout(set = 0, binding = 1) uniform Texels position_texels; // P,
layout(set = 0, binding = 2) uniform Texels normal_texels;   // Ng
layout(set = 0, binding = 3) uniform Texels triangles;       // 3 texels per slot, as prepare_triangles.comp writes them

const uint every_lane = SG < 32u ? (1u << SG) - 1u : 0xffffffffu;
uint turns = 0u;
vec3 sample_origin;
uint pairs = 0u, necessary = 0u, nodes = 0u, leaves = 0u;

#ifdef GRID
#include "techniques/common/shaders/mask_grid.glsl"
#else
#include "techniques/gears/shaders/mask_samples.glsl"
#endif

uint pixel;
bool idle;

// `lanes`: a bit for each view sample of the group that takes part; those without one stand in for the first.
void begin_group(uint g, uint lanes, FrameConstants f, Uints slots, Vec4s samples) {
  pixel = slots.at[g * SG + gl_SubgroupInvocationID];
  idle = pixel == no_sample || (lanes >> gl_SubgroupInvocationID & 1u) == 0u;
  // The first slots of a group hold samples. Shuffled by all lanes: in a branch, lane `first` would not take part.
  uint of_first = subgroupShuffle(pixel, uint(findLSB(lanes)));
  pixel = idle ? of_first : pixel;
  p = to_working(f.light, texel(origin_texels, pixel).xyz);
  pad = f.pad;
#ifdef GRID
  p.z = upper(p.z, pad);
#endif
  group_lo = lowest(p);
  group_hi = highest(p);
  begin_mask();
#ifdef GRID
  begin_shift(pixel, f);
#endif
#ifndef GRID
  sample_origin = f.light.origin.xyz;
  begin_light(f, samples);
#endif
}

void load_mask(Uints masks) {
  [[unroll]] for (int q = 0; q < WORDS; q++) mask[q] = masks.at[pixel * uint(WORDS) + uint(q)];
}

void store_mask(Uints masks) {
  if (!idle)
    [[unroll]] for (int q = 0; q < WORDS; q++) masks.at[pixel * uint(WORDS) + uint(q)] = mask[q];
}

void store_visibility(Floats visibility) {
  if (SAMPLES_SEEN == 0u) return;
  int blocked = 0;
  [[unroll]] for (int q = 0; q < WORDS; q++) blocked += bitCount(mask[q]);
  if (!idle) visibility.at[pixel] = float(int(SAMPLES_SEEN) - blocked) / float(SAMPLES_SEEN);
}

// Every view sample of the group sees no light sample any more.
bool all_blocked() {
  uint w = 0xffffffffu;
  [[unroll]] for (int q = 0; q < WORDS; q++) w &= mask[q];
  return COUNTING != 2u && or_of_all(~w) == 0u;
}

// Lanes are triangles: the one in `slot` of each lane with `wanted`. Then all that touch the mask are rasterised, lanes
// being view samples. `listed`: from the list, so possibly through the light's plane.
void rasterise_slots(uint slot, bool wanted, bool listed) {
  vec4 a = texel(triangles, slot * 3u);
  vec3 b = texel(triangles, slot * 3u + 1u).xyz, c = texel(triangles, slot * 3u + 2u).xyz;
  uint rect;
  bool touched = touches(lower(lower(a.xyz, b), c), upper(upper(a.xyz, b), c), rect);
  bool apart = listed ? separates(a.xyz, b, c) : a.w == 0.0;
  bool hit = touched && wanted && apart;
  uint left = ballot(hit);
  if (left == 0u) return;
  do {
    Bounds e;
    uint its_rect;
    bool some;
    do {   // to the next triangle that may cover a light sample of any view sample
      uint l = uint(findLSB(left));
      left &= left - 1u;
      vec3 A = vec3(subgroupShuffle(a.x, l), subgroupShuffle(a.y, l), subgroupShuffle(a.z, l)) - p;
      vec3 B = vec3(subgroupShuffle(b.x, l), subgroupShuffle(b.y, l), subgroupShuffle(b.z, l)) - p;
      vec3 C = vec3(subgroupShuffle(c.x, l), subgroupShuffle(c.y, l), subgroupShuffle(c.z, l)) - p;
      its_rect = subgroupShuffle(rect, l);
      e = bounds_of(A, B, C, listed);
      some = or_of_all(may_cover(e, its_rect) ? 1u : 0u) != 0u;
      turns++;
      if (COUNTING != 0u && !idle) pairs++;
    } while (!some && left != 0u);
    uint found = fill_rows(e, its_rect, some, listed, COUNTING != 0u);
    if (COUNTING != 0u && !idle) necessary += found != 0u ? 1u : 0u;
  } while (left != 0u);
}

void do_list(Uints list, uint begin, uint end) {
  uint i = begin;
  do {
    uint mine = i + gl_SubgroupInvocationID;
    bool wanted = mine < end;
    rasterise_slots(wanted ? list.at[mine] : 0u, wanted, true);
    i += SG;
    turns++;
  } while (i < end);
}

void add_wide(HeaderRef header, uint which, uint v) {
  uint old = which == 0u ? atomicAdd(header.h.nodes[0], v) : which == 1u ? atomicAdd(header.h.leaves[0], v)
             : which == 2u ? atomicAdd(header.h.pairs[0], v) : atomicAdd(header.h.necessary[0], v);
  if (old + v < old) {
    if (which == 0u) atomicAdd(header.h.nodes[1], 1u);
    if (which == 1u) atomicAdd(header.h.leaves[1], 1u);
    if (which == 2u) atomicAdd(header.h.pairs[1], 1u);
    if (which == 3u) atomicAdd(header.h.necessary[1], 1u);
  }
}

void add_statistics(HeaderRef header) {
  if (COUNTING == 0u) return;
  uint all_pairs = sum_of_all(pairs), all_necessary = sum_of_all(necessary);
  if (gl_SubgroupInvocationID == 0u) {
    add_wide(header, 0u, nodes);
    add_wide(header, 1u, leaves);
    add_wide(header, 2u, all_pairs);
    add_wide(header, 3u, all_necessary);
  }
}
