// The visibility mask of any set of light samples, one bit each: WORDS words of it at a time, from pc.first_word on.
// Samples are held against the triangle's three edge half-spaces and its plane, cluster by cluster; with a lookup table, the
// samples behind each plane are looked up [Sintorn2008, sec. 4.2].
layout(constant_id = 1) const int SAMPLES = 1;   // of the whole set
layout(constant_id = 4) const int WORDS = 1;
layout(constant_id = 5) const int TABLE = 0;     // entries along each axis; 0: planes are evaluated exactly
layout(constant_id = 15) const int TABLE_TEXELS = 1;
layout(constant_id = 21) const bool ABOVE_HORIZON = false;  // counts leave out what is below the horizon
layout(constant_id = 20) const uint MOVE = 0;    // PixelMove: 1 shift, 2 wrap, 3 turn

layout(constant_id = 24) const bool CLUSTERED = false;
// Samples of a cluster are neighbours, a half word or, where a pass has more than 32 of these, a word.
const int CLUSTER = WORDS > 16 ? 32 : 16, BOXED = 16;   // boxes are of BOXED samples
const int CLUSTERS = 32 * WORDS / CLUSTER;   // of a pass: at most 32, so that a word is a set of them
const int HELD = (CLUSTERS + int(SG) - 1) / int(SG);   // clusters that a lane holds the boxes of
// Boxes of triangles are held against boxes of clusters, where all view samples have the same.
const bool BY_CLUSTER = CLUSTERED && MOVE == 0u && TABLE == 0;

layout(set = 0, binding = 6) uniform sampler2D light_samples;    // SAMPLES in the world, then in working space; CLUSTERED: then per
                                                                 // cluster its box there, middle and half sides
layout(set = 0, binding = 7) uniform usampler2D table;           // TABLE_TEXELS per entry

vec3 p;
vec3 group_lo, group_hi;
uint mask[WORDS];
float pad, table_radius;   // table_radius: of the samples about the centre
vec3 light_middle, light_extent;
#include "techniques/common/shaders/hull_of_boxes.glsl"
uint first_word;
vec3 held_lo[HELD], held_hi[HELD];   // boxes of clusters k SG + lane of this pass
uint closed;                // clusters of which the view sample sees no sample any more
uint open_;                 // clusters of which some view sample of the group still sees one
// The light's bounds are cut into SG columns and as many rows. Clusters that reach to the right of the start of column
// `lane`, and to the left of its end; for rows likewise.
uint right_of, left_of, below_of, above_of;
vec2 cells_at, cells_per;

// Blocked from the start: no part in counts where ABOVE_HORIZON.
uint below_horizon[WORDS];
uint counted(uint bits, int word) {
  if (ABOVE_HORIZON)
    [[unroll]] for (int w = 0; w < WORDS; w++) bits &= w == word ? ~below_horizon[w] : 0xffffffffu;
  return uint(bitCount(bits));
}

#include "samples/shaders/light_rotation.h"
// Per-pixel rotation of the samples. Turning the planes about a symmetric light's axis instead of its samples
// [Sintorn2008, sec. 4.2] costs nothing per sample, and the table stays as it is: a plane's normal is turned, and q
// stands for p. A shift is taken from p alike. Only what wraps around a rectangle is moved sample by sample.
vec3 q;        // the view sample as the set, not moved, sees it
vec2 drawn;
vec4 move_axis, side_u, side_v;   // see light_setup.cpp

// About the light's axis by the drawn angle, `way` = 1, or back, -1; working space.
vec3 turned(vec3 v, float way) {
  vec3 a = move_axis.xyz;
  return drawn.x * v + way * side_u.w * drawn.y * cross(a, v) + (1.0 - drawn.x) * dot(a, v) * a;
}

vec3 plane_of_set(vec3 n) { return MOVE == 3u ? turned(n, -1.0) : n; }

void begin_move(uint pixel, FrameConstants f) {
  move_axis = f.first;
  side_u = f.step_u;
  side_v = f.step_v;
  q = p;
  uint seed = uint(f.first.w);
  if (MOVE == 1u || MOVE == 2u) drawn = vec2(rotation_unit(pixel, seed, 0u), rotation_unit(pixel, seed, 1u));
  if (MOVE == 1u) {
    drawn -= 0.5;
    q = p - vec3(side_u.w * drawn.x, side_v.w * drawn.y, 0.0);
  }
  if (MOVE == 3u) {
    rotation_turn(pixel, seed, drawn.x, drawn.y);
    q = turned(p, -1.0);
  }
}

// What a sample with these places in the rectangle moves by, in the rectangle's sides: around it, as on a torus.
vec2 wrapped(vec2 places) { return drawn - vec2(greaterThanEqual(places + drawn, vec2(1.0))); }

// The sample as the view sample takes it, in the world. w: its places, first here, second in working space.
vec3 moved_in_world(vec4 L, float place_v, FrameConstants f) {
  if (MOVE == 0u) return L.xyz;
  if (MOVE == 3u) {
    vec3 d = L.xyz - f.apex.xyz;
    return f.apex.xyz + vec3(drawn.x * d.x + drawn.y * d.z, d.y, drawn.x * d.z - drawn.y * d.x);
  }
  vec2 m = MOVE == 2u ? wrapped(vec2(L.w, place_v)) : drawn;
  return L.xyz + (side_u.xyz * m.x + side_v.xyz * m.y);
}

uint all_clusters() {
  int left = SAMPLES - 32 * int(first_word), n = min((left + CLUSTER - 1) / CLUSTER, CLUSTERS);
  return n >= 32 ? 0xffffffffu : (1u << n) - 1u;
}

vec3 from_lane(vec3 v, uint l) { return vec3(subgroupShuffle(v.x, l), subgroupShuffle(v.y, l), subgroupShuffle(v.z, l)); }

void hold_boxes() {
  const int boxes = CLUSTER / BOXED, last = (SAMPLES - 1) / BOXED;
  [[unroll]] for (int k = 0; k < HELD; k++) {
    held_lo[k] = vec3(1e30);
    held_hi[k] = vec3(-1e30);
    [[unroll]] for (int j = 0; j < boxes; j++) {
      int mine = 32 / BOXED * int(first_word) + (k * int(SG) + int(gl_SubgroupInvocationID)) * boxes + j;
      uint at = uint(2 * SAMPLES + 2 * min(mine, last));
      vec3 middle = texel(light_samples, at).xyz, extent = texel(light_samples, at + 1u).xyz;
      held_lo[k] = lower(held_lo[k], middle - extent);
      held_hi[k] = upper(held_hi[k], middle + extent);
    }
  }
}

void begin_clusters() {
  open_ = all_clusters();
  closed = 0u;
  if (!CLUSTERED) return;
  hold_boxes();
  cells_at = light_middle.xy - light_extent.xy;
  vec2 size = 2.0 * light_extent.xy / float(SG);
  cells_per = 1.0 / size;
  vec2 from = cells_at + size * (float(gl_SubgroupInvocationID) - 0.01), to = cells_at + size * (float(gl_SubgroupInvocationID) + 1.01);
  right_of = left_of = below_of = above_of = 0u;
  [[unroll]] for (int c = 0; c < CLUSTERS; c++) {
    uint l = uint(c) % SG, bit = 1u << c;
    vec3 lo = from_lane(held_lo[c / int(SG)], l), hi = from_lane(held_hi[c / int(SG)], l);
    right_of |= hi.x >= from.x ? bit : 0u;
    left_of |= lo.x <= to.x ? bit : 0u;
    below_of |= hi.y >= from.y ? bit : 0u;
    above_of |= lo.y <= to.y ? bit : 0u;
  }
}

// Clusters that may reach into a rectangle.
uint clusters_in(vec2 lo, vec2 hi) {
  const float last = float(SG - 1u);
  vec2 from = (lo - cells_at) * cells_per, to = (hi - cells_at) * cells_per;
  bool meets = from.x <= float(SG) && from.y <= float(SG) && to.x >= 0.0 && to.y >= 0.0;
  uint i0 = uint(clamp(from.x, 0.0, last)), i1 = uint(clamp(to.x, 0.0, last));
  uint j0 = uint(clamp(from.y, 0.0, last)), j1 = uint(clamp(to.y, 0.0, last));
  uint found = subgroupShuffle(right_of, i0) & subgroupShuffle(left_of, i1) & subgroupShuffle(below_of, j0) & subgroupShuffle(above_of, j1);
  return meets ? found : 0u;
}

void begin_light(FrameConstants f, uint word) {
  first_word = word;
  grow_lo = f.light_lo.xyz - group_lo;
  grow_hi = f.light_hi.xyz - group_hi;
  table_radius = f.light_lo.w;
  begin_clusters();
}

vec4 light_sample(int i, int of) { return texel(light_samples, uint(of * SAMPLES + min(i, SAMPLES - 1))); }

// n, P in world space, light samples too.
void block_horizon(vec3 P, vec3 n, FrameConstants f) {
  vec3 from_light = P - f.apex.xyz;
  bool behind = f.front.w != 0.0 && dot(f.front.xyz, from_light) <= 0.0;
  bool outside_cone = f.cone.w > -2.0 && dot(f.cone.xyz, from_light) < f.cone.w * length(from_light);
  behind = behind || outside_cone;
  [[unroll]] for (int word = 0; word < WORDS; word++) {
    uint w = 0u;
    for (int k = 0; k < 32; k += int(SG)) {
      int i = 32 * (int(first_word) + word) + k;
      vec4 mine = light_sample(i + int(gl_SubgroupInvocationID), 0);
      float place_v = MOVE == 2u ? light_sample(i + int(gl_SubgroupInvocationID), 1).w : 0.0;
      for (int l = 0; l < int(SG); l++) {
        vec4 sample_ = vec4(subgroupShuffle(mine.x, uint(l)), subgroupShuffle(mine.y, uint(l)), subgroupShuffle(mine.z, uint(l)), 0.0);
        if (MOVE == 2u) sample_.w = subgroupShuffle(mine.w, uint(l));
        vec3 L = moved_in_world(sample_, MOVE == 2u ? subgroupShuffle(place_v, uint(l)) : 0.0, f);
        bool blocked = !(dot(n, L - P) > 0.0), past = i + l >= SAMPLES;
        w |= blocked || past ? 1u << (k + l) : 0u;
      }
    }
    mask[word] = behind ? 0xffffffffu : w;
  }
}

void begin_mask() {}

void update_open() {
  closed = 0u;
  [[unroll]] for (int w = 0; w < WORDS; w++) {
    bool low = (mask[w] & 0xffffu) == 0xffffu, high = mask[w] >> 16u == 0xffffu;
    closed |= CLUSTER == 32 ? (low && high ? 1u << w : 0u) : (low ? 1u << (2 * w) : 0u) | (high ? 2u << (2 * w) : 0u);
  }
  open_ = or_of_all(~closed) & all_clusters();
}

vec2 lower2(vec2 a, vec2 b) { return mix(b, a, lessThan(a, b)); }
vec2 upper2(vec2 a, vec2 b) { return mix(b, a, greaterThan(a, b)); }

// Clusters of which a box may hide something from a view sample of the group.
//
// A point q hides from p the point q s + p (1 - s) of the plane z = l, s = (p.z - l) / (p.z - q.z) >= 1 where q lies between
// the light and p; s grows with q.z, and falls with p.z and l. As in mask_grid.glsl, for a light that is not flat.
uint clusters_behind(vec3 lo, vec3 hi) {
  float l1 = light_middle.z + light_extent.z, l0 = light_middle.z - light_extent.z;
  bool before_light = lo.z > l1 + 2.0 * pad;
  float wide = group_hi.z - lo.z + 2.0 * pad, rest = group_lo.z - hi.z - 2.0 * pad;
  float s0 = upper((group_hi.z - l1) / upper(wide, pad) * 0.99999, 1.0);
  float s1 = rest > pad ? upper((group_lo.z - l0) / rest * 1.00001, 1.0) : 1e30;
  vec2 least_ = lo.xy - group_hi.xy - 2.0 * pad, most = hi.xy - group_lo.xy + 2.0 * pad;
  vec2 from = lower2(least_ * s0, least_ * s1) + group_hi.xy - 8.0 * pad, to = upper2(most * s0, most * s1) + group_lo.xy + 8.0 * pad;
  uint found = clusters_in(from, to);
  return before_light ? found : 0xffffffffu;
}

// `rect`: the clusters of which the box may hide something that is not hidden from all the group.
bool touches(vec3 lo, vec3 hi, out uint rect) {
  bool met = meets_hull(lo, hi, 1.0) && lo.x <= hi.x;
  rect = open_;
  if (BY_CLUSTER) rect &= clusters_behind(lo, hi);
  return met && rect != 0u;
}

bool separates(vec3 a, vec3 b, vec3 c) { return true; }

// False where a half-space of the triangle, as p sees it, holds no point of the light's bounds.
bool may_hide(vec3 a, vec3 b, vec3 c) {
  vec3 ab = edge_normal(a, b), bc = edge_normal(b, c), ca = edge_normal(c, a), plane = edge_normal(b - a, c - a);
  float volume = ab.x * c.x + ab.y * c.y + ab.z * c.z, s = volume < 0.0 ? -1.0 : 1.0;
  vec3 middle = light_middle - p, reach = light_extent + 1e-5 * (abs(middle) + light_extent);
  bool may = true;
  [[unroll]] for (uint k = 0u; k < 3u; k++) {
    vec3 n = (k == 0u ? ab : k == 1u ? bc : ca) * s;
    float in_box = dot(n, middle) + dot(abs(n), reach);
    float in_ball = sqrt(dot(n, n)) * table_radius * 1.0001 - dot(n, p) + 1e-5 * dot(abs(n), abs(p));
    may = may && in_box >= 0.0 && in_ball >= 0.0;
  }
  float beyond = dot(plane * s, middle) + dot(abs(plane), reach);
  return may && beyond >= abs(volume) * 0.9999;
}

// Whether the view sample itself has the triangle (corners relative to p) between it and the light's bounds. Stricter than
// touches() and between() for its group: what a table says then hangs neither on the group nor on its order.
bool own_triangle(vec3 a, vec3 b, vec3 c) {
  vec3 reach = light_extent - 2.0 * pad, to_lo = light_middle - reach - p, to_hi = light_middle + reach - p;
  vec3 lo = lower(lower(a, b), c), hi = upper(upper(a, b), c);
  float t0 = 0.0, t1 = 1.0;
  [[unroll]] for (int k = 0; k < 3; k++) {
    float g = to_hi[k], r = lo[k] / (abs(g) < 1e-30 ? 1e-30 : g);
    t0 = upper(t0, g >= 0.0 ? r : t0);
    t1 = lower(t1, g < 0.0 ? r : t1);
    g = to_lo[k];
    r = hi[k] / (abs(g) < 1e-30 ? 1e-30 : g);
    t1 = lower(t1, g >= 0.0 ? r : t1);
    t0 = upper(t0, g < 0.0 ? r : t0);
  }
  vec3 n = edge_normal(b - a, c - a);
  float own = -dot(n, a), light = dot(n, light_middle - p - a), wide = dot(abs(n), reach);
  bool apart = (own > 0.0 && light > wide) || (own < 0.0 && light < -wide);
  return t0 <= t1 && !apart;
}

// Bits of a word that a sample owns.
uint owned_bits(int word) {
  int left = SAMPLES - 32 * (word + int(first_word));
  return left >= 32 ? 0xffffffffu : left <= 0 ? 0u : (1u << left) - 1u;
}

void add_bits(int word, uint bits) {
  [[unroll]] for (int w = 0; w < WORDS; w++) mask[w] |= w == word ? bits : 0u;
}

// A triangle's half-spaces: what it hides is on the positive side of the planes through the view sample and its edges,
// and beyond its own.
struct HalfSpaces {
  vec3 ab, bc, ca, plane;
  float volume;
};

// Of the triangle as the view sample sees it, and as the set, not moved, does.
HalfSpaces half_spaces(vec3 a, vec3 b, vec3 c) {
  HalfSpaces h = HalfSpaces(edge_normal(a, b), edge_normal(b, c), edge_normal(c, a), edge_normal(b - a, c - a), 0.0);
  float volume = h.ab.x * c.x + h.ab.y * c.y + h.ab.z * c.z, s = volume < 0.0 ? -1.0 : 1.0;
  return HalfSpaces(plane_of_set(h.ab) * s, plane_of_set(h.bc) * s, plane_of_set(h.ca) * s, plane_of_set(h.plane) * s, abs(volume));
}

// First texel of the table's entry for the plane through the view sample with normal n, and whether its complement is
// meant: opposite planes share an entry, so that a common edge leaves no gap between two triangles.
uint table_entry(vec3 n, bool inner_is_positive, out uint flip) {
  bool opposite = n.z < 0.0 || (n.z == 0.0 && (n.y < 0.0 || (n.y == 0.0 && n.x < 0.0)));
  n = opposite ? -n : n;
  flip = opposite == inner_is_positive ? 0xffffffffu : 0u;
  n *= inversesqrt(max(dot(n, n), 1e-37));
  float size = float(TABLE), distance_ = dot(n, q) / table_radius;
  float azimuth = atan(n.y, n.x) * 0.159154943 + 0.5, polar = acos(clamp(n.z, 0.0, 1.0)) * 0.636619772;
  vec3 at = clamp(vec3(azimuth, polar, distance_ * 0.5 + 0.5) * size, vec3(0.0), vec3(size - 1.0));
  return ((uint(at.z) * uint(TABLE) + uint(at.y)) * uint(TABLE) + uint(at.x)) * uint(TABLE_TEXELS);
}

uvec4 table_bits(uint at) { return texelFetch(table, ivec2(at & 8191u, at >> 13u), 0); }

uint look_up(HalfSpaces h, bool own, bool counting) {
  uint flip0, flip1, flip2, found = 0u;
  uint e0 = table_entry(h.ab, true, flip0), e1 = table_entry(h.bc, true, flip1), e2 = table_entry(h.ca, true, flip2);
  // Words of an entry come four to a texel; a pass begins at a multiple of four.
  uint first = first_word >> 2u;
  [[unroll]] for (uint k = 0u; k < uint(WORDS + 3) / 4u; k++) {
    uint at = min(first + k, uint(TABLE_TEXELS) - 1u);
    uvec4 bits = (table_bits(e0 + at) ^ flip0) & (table_bits(e1 + at) ^ flip1) & (table_bits(e2 + at) ^ flip2);
    bits = own ? bits : uvec4(0u);
    [[unroll]] for (uint j = 0u; j < 4u; j++) {
      if (4u * k + j >= uint(WORDS)) break;
      mask[4u * k + j] |= bits[j];
      if (counting) found += counted(bits[j], int(4u * k + j));
    }
  }
  return found;
}

uint word_of_mask(int word) {
  uint found = 0u;
  [[unroll]] for (int w = 0; w < WORDS; w++) found |= w == word ? mask[w] : 0u;
  return found;
}

// Clusters that the triangle may hide a part of from the view sample: those in the rectangle about the triangle's projection
// onto the planes between which the light lies. Corners relative to p.
uint clusters_of(vec3 a, vec3 b, vec3 c) {
  if (!CLUSTERED || MOVE == 2u) return all_clusters();
  a = plane_of_set(a);
  b = plane_of_set(b);
  c = plane_of_set(c);
  float l0 = light_middle.z - light_extent.z, l1 = light_middle.z + light_extent.z;
  // How far p is before the planes, and before the corners.
  float h0 = q.z - l0, h1 = q.z - l1;
  vec3 t = -vec3(a.z, b.z, c.z);
  bool between_ = lower(t) > 4.0 * pad && upper(t) < h1 - 4.0 * pad;
  vec3 inverse = 1.0 / upper(t, vec3(pad)), x = vec3(a.x, b.x, c.x) * inverse, y = vec3(a.y, b.y, c.y) * inverse;
  float x0 = lower(x), x1 = upper(x), y0 = lower(y), y1 = upper(y), slack = 8.0 * pad;
  vec2 from = vec2(lower(x0 * h0, x0 * h1), lower(y0 * h0, y0 * h1)) + q.xy - slack;
  vec2 to = vec2(upper(x1 * h0, x1 * h1), upper(y1 * h0, y1 * h1)) + q.xy + slack;
  uint found = clusters_in(from, to);
  return (between_ ? found : 0xffffffffu) & all_clusters();
}

// Which of a cluster's samples are hidden.
uint evaluate_cluster(HalfSpaces h, int cluster) {
  uint bits = 0u;
  const int step_ = min(int(SG), CLUSTER);
  [[unroll]] for (int k = 0; k < CLUSTER; k += step_) {
    int i = 32 * int(first_word) + CLUSTER * cluster + k;
    vec4 mine = light_sample(i + int(gl_SubgroupInvocationID), 1);
    float place_u = MOVE == 2u ? light_sample(i + int(gl_SubgroupInvocationID), 0).w : 0.0;
    [[unroll]] for (int l = 0; l < step_; l++) {
      vec3 d = from_lane(mine.xyz, uint(l)) - q;
      if (MOVE == 2u)
        d.xy += wrapped(vec2(subgroupShuffle(place_u, uint(l)), subgroupShuffle(mine.w, uint(l)))) * vec2(side_u.w, side_v.w);
      precise float e0 = h.ab.x * d.x + h.ab.y * d.y + h.ab.z * d.z;
      precise float e1 = h.bc.x * d.x + h.bc.y * d.y + h.bc.z * d.z;
      precise float e2 = h.ca.x * d.x + h.ca.y * d.y + h.ca.z * d.z;
      bool hidden = e0 >= 0.0 && e1 >= 0.0 && e2 >= 0.0;
      bool beyond = dot(h.plane, d) > h.volume, owned = i + l < SAMPLES;
      bits |= hidden && beyond && owned ? 1u << (k + l) : 0u;
    }
  }
  return bits;
}

// Hides samples of a cluster from the view sample; returns how many where `counting`.
uint hide(uint bits, int cluster, bool counting) {
  int word = CLUSTER == 32 ? cluster : cluster / 2, shift = CLUSTER == 32 ? 0 : 16 * (cluster & 1);
  const uint full = CLUSTER == 32 ? 0xffffffffu : 0xffffu;
  add_bits(word, bits << shift);
  bool all_ = (word_of_mask(word) >> shift & full) == full && !counting;
  closed |= all_ ? 1u << cluster : 0u;
  return counting ? counted(bits << shift & owned_bits(word), word) : 0u;
}

// Whether the triangle hides a cluster's box as a whole, x, or a part of it, y: half-spaces at the corners of the box, with
// more than rounding to spare.
bvec2 hides_box(HalfSpaces h, int cluster) {
  vec3 lo = held_lo[0], hi = held_hi[0];
  [[unroll]] for (int k = 1; k < HELD; k++) {
    lo = cluster / int(SG) == k ? held_lo[k] : lo;
    hi = cluster / int(SG) == k ? held_hi[k] : hi;
  }
  uint l = uint(cluster) % SG;
  lo = from_lane(lo, l);
  hi = from_lane(hi, l);
  vec3 d = 0.5 * (lo + hi) - q, e = 0.5 * (hi - lo);
  e += 2e-6 * (abs(d) + e);
  vec3 nx = vec3(h.ab.x, h.bc.x, h.ca.x), ny = vec3(h.ab.y, h.bc.y, h.ca.y), nz = vec3(h.ab.z, h.bc.z, h.ca.z);
  vec3 at = nx * d.x + ny * d.y + nz * d.z, reach = abs(nx) * e.x + abs(ny) * e.y + abs(nz) * e.z;
  float beyond = dot(h.plane, d) - h.volume, wide = dot(abs(h.plane), e) + 1e-6 * h.volume;
  bool whole = lower(lower(at - reach), beyond - wide) > 0.0, part = lower(lower(at + reach), beyond + wide) >= 0.0;
  return bvec2(whole, part && !whole);
}

// Of the clusters that view samples ask for, `asked`: those that the triangle hides as a whole are hidden, those that it hides
// a part of are left. Returns how many samples are hidden where `counting`.
uint ask_boxes(HalfSpaces h, inout uint asked, bool counting) {
  if (!CLUSTERED || MOVE == 2u) return 0u;
  uint found = 0u, all_ = or_of_all(asked), parts = 0u;
  do {
    int cluster = all_ != 0u ? findLSB(all_) : 0;
    all_ &= all_ - 1u;
    bool mine = (asked >> cluster & 1u) != 0u;
    bvec2 is = hides_box(h, cluster);
    parts |= mine && is.y ? 1u << cluster : 0u;
    found += hide(mine && is.x ? 0xffffffffu >> (32 - CLUSTER) : 0u, cluster, counting);
    turns++;
  } while (all_ != 0u);
  asked = parts;
  return found;
}

// Samples of the clusters `asked`. Returns how many are hidden where `counting`.
uint hide_samples(HalfSpaces h, uint asked, bool counting) {
  uint found = 0u, all_ = or_of_all(asked);
  do {
    int cluster = all_ != 0u ? findLSB(all_) : 0;
    all_ &= all_ - 1u;
    uint bits = evaluate_cluster(h, cluster);
    found += hide((asked >> cluster & 1u) != 0u ? bits : 0u, cluster, counting);
    turns++;
  } while (all_ != 0u);
  return found;
}

// As the view sample takes it, working space.
vec3 sample_at(int i) {
  vec4 s = light_sample(32 * int(first_word) + i, 1);
  if (MOVE == 3u) return turned(s.xyz, 1.0);
  if (MOVE == 2u) return s.xyz + vec3(wrapped(vec2(light_sample(32 * int(first_word) + i, 0).w, s.w)) * vec2(side_u.w, side_v.w), 0.0);
  return s.xyz + (p - q);
}
