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
layout(constant_id = 15) const bool PAIRED = true;       // rasterises two triangles at a time
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
vec3 position, normal;   // P and Ng of the pixel

// What a group needs of its view samples. Fetched while the group before it is done, all of it together, since what was
// not used for long comes slowly.
struct Fetched {
  uint pixel;
  bool idle;
  vec3 origin, position, normal;
  uint touched;   // a word of the mask's place: it is near when the mask is stored
};

// `lanes`: a bit for each view sample of the group that takes part; those without one stand in for the first.
Fetched fetch_group(uint g, uint lanes, Uints slots, Uints masks) {
  Fetched s;
  s.pixel = slots.at[g * SG + gl_SubgroupInvocationID];
  s.idle = s.pixel == no_sample || (lanes >> gl_SubgroupInvocationID & 1u) == 0u;
  // The first slots of a group hold samples. Shuffled by all lanes: in a branch, lane `first` would not take part.
  uint of_first = subgroupShuffle(s.pixel, uint(max(findLSB(lanes), 0)));
  s.pixel = s.idle ? of_first : s.pixel;
  s.origin = texel(origin_texels, s.pixel).xyz;
  s.position = texel(position_texels, s.pixel).xyz;
  s.normal = texel(normal_texels, s.pixel).xyz;
  s.touched = masks.at[s.pixel * uint(WORDS)];
  return s;
}

void begin_group(Fetched s, FrameConstants f, Vec4s samples) {
  pixel = s.pixel;
  idle = s.idle;
  turns += s.touched == 0x5bd1e995u ? 1u : 0u;   // used, so that it is fetched
  position = s.position;
  normal = s.normal;
  p = to_working(f.light, s.origin);
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

// A triangle in each lane, and the light samples that it may hide.
struct Triangles {
  vec3 a, b, c;
  uint rect;
};

// Lanes are triangles: the one in `slot` of each lane with `wanted`. Returns a bit for each that may hide a light sample
// from a view sample of the group. `listed`: from the list, so possibly through the light's plane.
uint find(uint slot, bool wanted, bool listed, out Triangles t) {
  vec4 a = texel(triangles, slot * 3u);
  t.a = a.xyz;
  t.b = texel(triangles, slot * 3u + 1u).xyz;
  t.c = texel(triangles, slot * 3u + 2u).xyz;
  bool touched = touches(lower(lower(t.a, t.b), t.c), upper(upper(t.a, t.b), t.c), t.rect);
  bool may = COUNTING == 2u || may_hide(t.a, t.b, t.c, t.rect);
  bool here = listed || a.w == 0.0;
  return ballot(touched && wanted && may && here);
}

// The triangle of lane l, seen from this view sample.
Bounds bounds_of_lane(Triangles t, uint l, bool listed) {
  vec3 a = vec3(subgroupShuffle(t.a.x, l), subgroupShuffle(t.a.y, l), subgroupShuffle(t.a.z, l)) - p;
  vec3 b = vec3(subgroupShuffle(t.b.x, l), subgroupShuffle(t.b.y, l), subgroupShuffle(t.b.z, l)) - p;
  vec3 c = vec3(subgroupShuffle(t.c.x, l), subgroupShuffle(t.c.y, l), subgroupShuffle(t.c.z, l)) - p;
  return bounds_of(a, b, c, listed);
}

// Lanes are view samples: rasterises the triangles of the lanes in `left`; where PAIRED two at a time, an odd one twice.
void rasterise_found(Triangles t, uint left, bool listed) {
  do {
    uint l = uint(findLSB(left)), m = l;
    left &= left - 1u;
    bool two = PAIRED && !listed && left != 0u;
    if (PAIRED && !listed) {
      m = two ? uint(findLSB(left)) : l;
      left &= left - 1u;
    }
    Bounds e = bounds_of_lane(t, l, listed), f = e;
    if (PAIRED && !listed) f = bounds_of_lane(t, m, listed);
    uvec2 found = fill_rows(e, f, subgroupShuffle(t.rect, l), subgroupShuffle(t.rect, m), listed, COUNTING != 0u);
    turns++;
    if (COUNTING != 0u && !idle) {
      pairs += two ? 2u : 1u;
      necessary += found.x != 0u ? 1u : 0u;
      necessary += found.y != 0u && two ? 1u : 0u;
    }
  } while (left != 0u);
}

void rasterise_slots(uint slot, bool wanted, bool listed) {
  Triangles t;
  uint left = find(slot, wanted, listed, t);
  if (left != 0u) rasterise_found(t, left, listed);
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
