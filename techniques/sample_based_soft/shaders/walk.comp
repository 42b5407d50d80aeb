// A group of view samples of one list goes through the list's casters: lanes are blocks of triangles, then triangles, then
// view samples.
//
// HARD: the group lies in no penumbra. One light sample above the view sample's horizon then stands for all.
//
// lavapipe silently ends loops after 65,535 turns of an invocation, all its loops together: every loop counts `turns`,
// and a group that nears TURN_LIMIT writes down where it is and goes on in another dispatch.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "techniques/sample_based_soft/shaders/frame.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 6) const bool RESUMED = false;
layout(constant_id = 7) const bool BLOCKS = true;
layout(constant_id = 8) const uint TURN_LIMIT = 20000;
layout(constant_id = 9) const uint COUNTING = 0;         // 1: statistics of this walk; 2: and no pair is skipped
layout(constant_id = 10) const bool BEGIN = true;        // this dispatch begins the masks,
layout(constant_id = 11) const bool LIST = true;         // does a part of the triangles outside the blocks,
layout(constant_id = 12) const bool WALK = true;         // walks the list's casters
layout(constant_id = 13) const uint SAMPLES_SEEN = 0;    // not 0: visibility is written too, from so many light samples
layout(constant_id = 16) const bool HARD = false;
layout(constant_id = 17) const bool WORK = false;        // groups come from a list of work
layout(constant_id = 18) const bool CULL_PLANES = true;  // leave out triangles whose plane has light and group on one side
layout(constant_id = 19) const uint MASK_WORDS = 8;      // words of a whole mask
// Transparent triangles: visibility is the share of light samples above the horizon, times 1 - OPACITY c for every
// triangle that covers the share c of them. ABOVE_HORIZON (in the masks) is then set, and no pair is skipped.
layout(constant_id = 22) const float OPACITY = 1.0;
layout(constant_id = 23) const uint ALL_SAMPLES = 1;
#include "techniques/common/shaders/subgroup.glsl"
#include "techniques/common/shaders/texels.glsl"
#include "techniques/common/shaders/edge_half_spaces.glsl"
#include "techniques/sample_based_soft/shaders/lists.glsl"

layout(set = 0, binding = 0) uniform sampler2D frame_texels;     // FrameConstants
layout(set = 0, binding = 1) uniform sampler2D origin_texels;    // per pixel: P' (w = 0: no view sample),
layout(set = 0, binding = 2) uniform sampler2D position_texels;  // P,
layout(set = 0, binding = 3) uniform sampler2D normal_texels;    // Ng
layout(set = 0, binding = 4) uniform sampler2D triangles;        // 3 texels per slot
layout(set = 0, binding = 5) uniform sampler2D regions;          // 2 texels per caster
layout(push_constant) uniform Push { WalkConstants pc; };

uint turns = 0u, tests = 0u, pairs = 0u, necessary = 0u;
#ifdef GRID
#include "techniques/common/shaders/mask_grid.glsl"
vec3 sample_at(int i) { return vec3(vec2(float(i % PITCH), float(i / PITCH)) + shift, 0.0); }
#else
#include "techniques/sample_based_soft/shaders/mask_any.glsl"
#endif
uint pixel;
bool idle;
vec3 target;          // HARD: the light sample that stands for all
bool hidden_ = false;
float above, through;   // ABOVE_HORIZON: light samples above the horizon, and the visibility so far
#ifdef GRID
vec3 light_middle, light_extent;
#endif

FrameConstants frame_constants() {
  FrameConstants f;
  f.light = light_basis(frame_texels);
  f.light_lo = texel(frame_texels, light_lo_texel);
  f.light_hi = texel(frame_texels, light_hi_texel);
  f.first = texel(frame_texels, first_texel);
  f.step_u = texel(frame_texels, step_u_texel);
  f.step_v = texel(frame_texels, step_v_texel);
  f.cone = texel(frame_texels, cone_texel);
  f.apex = texel(frame_texels, apex_texel);
  f.front = texel(frame_texels, front_texel);
  f.pad = texel(frame_texels, pad_texel).x;
  return f;
}

void begin_group(uint g, FrameConstants f) {
  pixel = pc.slots.at[g * SG + gl_SubgroupInvocationID];
  idle = pixel == no_sample;
  // The first slot of a group holds a sample. Shuffled by all lanes, outside of any condition.
  uint of_first = subgroupShuffle(pixel, 0u);
  pixel = idle ? of_first : pixel;
  p = to_working(f.light, texel(origin_texels, pixel).xyz);
  pad = f.pad;
#ifdef GRID
  p.z = upper(p.z, pad);
#endif
  group_lo = lowest(p);
  group_hi = highest(p);
  light_middle = 0.5 * (f.light_lo.xyz + f.light_hi.xyz);
  light_extent = 0.5 * (f.light_hi.xyz - f.light_lo.xyz) + 2.0 * f.pad;
  begin_mask();
#ifdef GRID
  begin_shift(pixel, f);
#else
  begin_light(f, pc.first_word);
  begin_move(pixel, f);
#endif
}

void load_mask() {
  [[unroll]] for (int q = 0; q < WORDS; q++)
    mask[q] = pc.first_word + uint(q) < MASK_WORDS ? pc.masks.at[pixel * MASK_WORDS + pc.first_word + uint(q)] : 0xffffffffu;
}

void store_mask() {
  [[unroll]] for (int q = 0; q < WORDS; q++)
    if (!idle && pc.first_word + uint(q) < MASK_WORDS) pc.masks.at[pixel * MASK_WORDS + pc.first_word + uint(q)] = mask[q];
}

void store_visibility() {
  if (SAMPLES_SEEN == 0u) return;
  int blocked = 0;
  [[unroll]] for (int q = 0; q < WORDS; q++) blocked += bitCount(mask[q]);
  if (!idle) pc.visibility.at[pixel] = float(int(SAMPLES_SEEN) - blocked) / float(SAMPLES_SEEN);
}

// Every pair of view sample and triangle counts, whether or not its light samples are hidden already.
bool skips_nothing() { return COUNTING == 2u || ABOVE_HORIZON; }

// After block_horizon(), before load_mask().
void begin_through() {
  int blocked = 0;
  [[unroll]] for (int q = 0; q < WORDS; q++) {
    below_horizon[q] = mask[q];
    blocked += bitCount(mask[q]);
  }
  above = float(32 * WORDS - blocked);
  through = BEGIN ? above / float(ALL_SAMPLES) : pc.visibility.at[pixel];
}
void store_through() {
  if (ABOVE_HORIZON && !idle) pc.visibility.at[pixel] = through;
}

bool is_full() {
  uint w = 0xffffffffu;
  [[unroll]] for (int q = 0; q < WORDS; q++) w &= mask[q];
  return w == 0xffffffffu;
}

// Every view sample of the group sees no light sample any more.
bool all_blocked() {
  bool blocked = is_full() || (HARD && hidden_);
  return ballot(!blocked) == 0u && !skips_nothing();
}

// The first light sample that is above the horizon.
void choose_target() {
  int i = 0;
  [[unroll]] for (int q = WORDS - 1; q >= 0; q--) i = ~mask[q] != 0u ? 32 * q + findLSB(~mask[q]) : i;
  target = sample_at(i);
}

// Whether the triangle lies between p and the target.
bool hides_target(vec3 a, vec3 b, vec3 c) {
  vec3 ab = edge_normal(a, b), bc = edge_normal(b, c), ca = edge_normal(c, a), plane = edge_normal(b - a, c - a);
  float volume = ab.x * c.x + ab.y * c.y + ab.z * c.z, s = volume < 0.0 ? -1.0 : 1.0;
  vec3 d = target - p;
  precise float e0 = ab.x * d.x + ab.y * d.y + ab.z * d.z;
  precise float e1 = bc.x * d.x + bc.y * d.y + bc.z * d.z;
  precise float e2 = ca.x * d.x + ca.y * d.y + ca.z * d.z;
  return e0 * s >= 0.0 && e1 * s >= 0.0 && e2 * s >= 0.0 && dot(plane, d) * s > abs(volume);
}

// False where the triangle's plane has the light and all view samples of the group on one side [Lehtinen2006].
bool between(vec3 a, vec3 b, vec3 c) {
  vec3 n = edge_normal(b - a, c - a);
  vec3 middle = 0.5 * (group_lo + group_hi) - a, extent = 0.5 * (group_hi - group_lo) + 2.0 * pad;
  float g = dot(n, middle), reach = dot(abs(n), extent);
  float l = dot(n, light_middle - a), wide = dot(abs(n), light_extent);
  vec3 u = abs(b - a), v = abs(c - a);
  vec3 turn = 4.0 * pad * (u.yzx + u.zxy + v.yzx + v.zxy) + 1e-6 * (u.yzx * v.zxy + u.zxy * v.yzx);
  reach += dot(turn, abs(middle) + extent);
  wide += dot(turn, abs(light_middle - a) + light_extent);
  return !((g > reach && l > wide) || (g < -reach && l < -wide));
}

// Of a corner that lane l holds, relative to p.
vec3 corner_of(vec3 v, uint l) {
  return vec3(subgroupShuffle(v.x, l), subgroupShuffle(v.y, l), subgroupShuffle(v.z, l)) - p;
}

// A triangle that covers so many of the light samples was held against the view sample.
void note(uint found) {
  if (ABOVE_HORIZON) through *= above > 0.0 ? 1.0 - OPACITY * float(found) / above : 0.0;
  if (COUNTING != 0u && !idle) {
    pairs++;
    necessary += found != 0u ? 1u : 0u;
  }
}

// A triangle for each lane, those that may hide something in `left`.
struct Triangles {
  vec3 a, b, c;
  uint rect, left;
};

// The one in `slot` of each lane with `wanted`. `listed`: from outside the blocks, so possibly through the light's plane.
Triangles find_triangles(uint slot, bool wanted, bool listed) {
  Triangles t;
  vec4 a = texel(triangles, slot * 3u);
  t.a = a.xyz;
  t.b = texel(triangles, slot * 3u + 1u).xyz;
  t.c = texel(triangles, slot * 3u + 2u).xyz;
  bool touched = touches(lower(lower(t.a, t.b), t.c), upper(upper(t.a, t.b), t.c), t.rect);
  bool apart = true;
  if (CULL_PLANES || listed) apart = between(t.a, t.b, t.c);
  bool meant = listed || a.w == 0.0;
  bool hit = touched && wanted && apart && meant;
  t.left = ballot(hit);
  return t;
}

#ifdef GRID
void rasterise_all(Triangles t, bool listed) {
  do {
    uint l = uint(findLSB(t.left));
    t.left &= t.left - 1u;
    note(rasterise(corner_of(t.a, l), corner_of(t.b, l), corner_of(t.c, l), subgroupShuffle(t.rect, l), listed,
                   COUNTING != 0u || ABOVE_HORIZON));
    turns++;
  } while (t.left != 0u);
}
#else
void rasterise_all(Triangles t, bool listed) {
  const bool counting = COUNTING != 0u || ABOVE_HORIZON;
  do {
    HalfSpaces h;
    uint asked, some, found;
    do {   // to the next triangle of which some view sample has to evaluate light samples: that is dear
      uint l = uint(findLSB(t.left));
      t.left &= t.left - 1u;
      vec3 a = corner_of(t.a, l), b = corner_of(t.b, l), c = corner_of(t.c, l);
      h = half_spaces(a, b, c);
      asked = clusters_of(a, b, c);
      if (!skips_nothing()) asked &= ~closed;
      if (TABLE > 0) asked = may_hide(a, b, c) && (listed || own_triangle(a, b, c)) ? asked : 0u;
      found = 0u;
      if (TABLE == 0 || listed) found = ask_boxes(h, asked, counting);
      some = ballot(asked != 0u);
      turns++;
      if (some == 0u && t.left != 0u) note(found);
    } while (some == 0u && t.left != 0u);
    if (TABLE > 0 && !listed) {
      if (some != 0u) found = look_up(h, asked != 0u, counting);
    } else {
      found += hide_samples(h, asked, counting);
    }
    note(found);
  } while (t.left != 0u);
}
#endif

// Lanes were triangles; now they are view samples, and each triangle is held against them all.
void hide_by(Triangles t, bool listed) {
  if (t.left == 0u) return;
  if (!HARD) {
    rasterise_all(t, listed);
    return;
  }
  do {
    uint l = uint(findLSB(t.left));
    t.left &= t.left - 1u;
    bool hides = hides_target(corner_of(t.a, l), corner_of(t.b, l), corner_of(t.c, l));
    hidden_ = hidden_ || hides;
    turns++;
    note(hides ? 1u : 0u);
  } while (t.left != 0u);
}

void do_list() {
  uint i = pc.list_begin;
  do {
    Triangles t;
    do {   // a branch saves no work here, fewer turns do
      uint mine = i + gl_SubgroupInvocationID;
      bool wanted = mine < pc.list_end;
      t = find_triangles(wanted ? pc.list.at[mine] : 0u, wanted, true);
      i += SG;
      turns++;
    } while (t.left == 0u && i < pc.list_end);
    hide_by(t, true);
  } while (i < pc.list_end);
}

// Lanes are casters, from `done` on: a bit for each block that may hide something.
uint find_blocks(uint caster, bool wanted) {
  vec4 a = texel(regions, 2u * caster), b = texel(regions, 2u * caster + 1u);
  uint rect;
  bool touched = touches(a.xyz, vec3(a.w, b.xy), rect);
  bool hit = touched && wanted;
  return ballot(hit);
}

// Goes on after `done` casters; returns how many are done, or 0xffffffff when all are.
uint walk(uint list, uint done) {
  bool outside = list == pc.outside_list;
  uint begin = outside ? 0u : pc.begins.at[list] - pc.chunk_begin, count = outside ? pc.caster_count : pc.counts.at[list];
  bool full = false;
  if (done < count) {
    do {
      uint left = 0u, caster, at;
      Triangles t;
      do {   // to the next casters of which some may hide something
        at = done;
        uint mine = at + gl_SubgroupInvocationID, i = min(mine, count - 1u);
        bool wanted = mine < count;
        caster = outside ? i : pc.casters.at[begin + i];
        if (COUNTING != 0u) tests += wanted ? 1u : 0u;
        if (BLOCKS) {
          left = find_blocks(caster, wanted);
        } else {
          t = find_triangles(caster, wanted, false);
          left = t.left;
        }
        done += SG;
        turns++;
      } while (left == 0u && done < count && turns < TURN_LIMIT);
      if (BLOCKS) {
        if (left != 0u) {
          do {
            do {
              uint l = uint(findLSB(left));
              left &= left - 1u;
              t = find_triangles(subgroupShuffle(caster, l) * SG + gl_SubgroupInvocationID, true, false);
              turns++;
            } while (t.left == 0u && left != 0u);
            hide_by(t, false);
            full = all_blocked();
            // Enough for this dispatch: the next one begins at the first block that is left.
            bool stop = turns >= TURN_LIMIT;
            done = stop && left != 0u ? at + uint(findLSB(left)) : done;
            left = stop || full ? 0u : left;
          } while (left != 0u);
          if (!skips_nothing()) update_open();
        }
      } else {
        hide_by(t, false);
        full = all_blocked();
        if (!skips_nothing()) update_open();
      }
    } while (done < count && !full && turns < TURN_LIMIT);
  }
  return done < count && !full ? done : 0xffffffffu;
}

void add_wide(uint which, uint v) {
  uint old = which == 0u ? atomicAdd(pc.header.h.tests[0], v) : which == 1u ? atomicAdd(pc.header.h.pairs[0], v)
                                                                : atomicAdd(pc.header.h.necessary[0], v);
  if (old + v < old) {
    if (which == 0u) atomicAdd(pc.header.h.tests[1], 1u);
    if (which == 1u) atomicAdd(pc.header.h.pairs[1], 1u);
    if (which == 2u) atomicAdd(pc.header.h.necessary[1], 1u);
  }
}

void add_statistics() {
  if (COUNTING == 0u) return;
  uint all_tests = sum_of_all(tests), all_pairs = sum_of_all(pairs), all_necessary = sum_of_all(necessary);
  if (gl_SubgroupInvocationID == 0u) {
    add_wide(0u, all_tests);
    add_wide(1u, all_pairs);
    add_wide(2u, all_necessary);
  }
}

// Groups that cost much are neighbours; a device that deals its threads contiguous work would leave them all to one.
// Over a rectangle of 64 rows of 16; what a dispatch has beyond it does nothing.
uint interleaved(uint n) {
  uint columns = ((pc.work_groups + 15u) / 16u + 63u) / 64u, chunk = n / 16u;
  return n < 1024u * columns ? ((chunk % 64u) * columns + chunk / 64u) * 16u + n % 16u : 0xffffffffu;
}

void main() {
  uint n = RESUMED ? linear_group() : interleaved(linear_group());
  if (n >= pc.work_groups) return;
  uint g = RESUMED ? pc.resume.at[pc.read_list * pc.capacity + n] : WORK ? pc.work.at[pc.first_group + n] : pc.first_group + n;
  FrameConstants f = frame_constants();
  begin_group(g, f);
  if (ABOVE_HORIZON) {
    block_horizon(texel(position_texels, pixel).xyz, texel(normal_texels, pixel).xyz, f);
    begin_through();
  }
  if (!BEGIN) load_mask();
  if (HARD) hidden_ = !BEGIN && is_full();
  if ((BEGIN && !ABOVE_HORIZON) || HARD) block_horizon(texel(position_texels, pixel).xyz, texel(normal_texels, pixel).xyz, f);
  if (HARD) choose_target();
#ifndef GRID
  if (BEGIN && !HARD && !skips_nothing()) update_open();
#endif
  if (LIST) do_list();
  if (WALK) {
    if (!BEGIN && !HARD && !skips_nothing()) update_open();
    uint next = 0xffffffffu;
    if (!all_blocked()) next = walk(pc.group_lists.at[g], RESUMED ? pc.resume.at[2u * pc.capacity + g] : 0u);
    if (next != 0xffffffffu && gl_SubgroupInvocationID == 0u) {
      pc.resume.at[(1u - pc.read_list) * pc.capacity + atomicAdd(pc.header.h.resume_count, 1u)] = g;
      pc.resume.at[2u * pc.capacity + g] = next;
    }
  }
  if (HARD)
    [[unroll]] for (int q = 0; q < WORDS; q++) mask[q] = hidden_ ? 0xffffffffu : mask[q];
  store_mask();
  store_visibility();
  store_through();
  add_statistics();
}
