// The visibility mask of any set of light samples, one bit each: WORDS words of it at a time, from pc.first_word on.
// Every sample is held against the triangle's three edge half-spaces and its plane; with a lookup table, the samples
// behind each plane are looked up [Sintorn2008, sec. 4.2].
layout(constant_id = 1) const int SAMPLES = 1;   // of the whole set
layout(constant_id = 4) const int WORDS = 1;
layout(constant_id = 5) const int TABLE = 0;     // entries along each axis; 0: planes are evaluated exactly
layout(constant_id = 15) const int TABLE_TEXELS = 1;
layout(constant_id = 21) const bool ABOVE_HORIZON = false;  // counts leave out what is below the horizon
layout(constant_id = 20) const uint MOVE = 0;    // PixelMove: 1 shift, 2 wrap, 3 turn

layout(constant_id = 24) const bool CLUSTERED = false;
const int CLUSTER = 16, LAST_CLUSTER = (SAMPLES - 1) / CLUSTER;   // samples of a cluster: neighbours, half a word

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

void begin_light(FrameConstants f, uint word) {
  first_word = word;
  grow_lo = f.light_lo.xyz - group_lo;
  grow_hi = f.light_hi.xyz - group_hi;
  table_radius = f.light_lo.w;
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
void update_open() {}

bool touches(vec3 lo, vec3 hi, out uint rect) {
  rect = 0u;
  return meets_hull(lo, hi, 1.0) && lo.x <= hi.x;
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

// Bits of a word that a sample owns.
uint owned_bits(int word) {
  int left = SAMPLES - 32 * (word + int(first_word));
  return left >= 32 ? 0xffffffffu : left <= 0 ? 0u : (1u << left) - 1u;
}

void add_bits(int word, uint bits) {
  [[unroll]] for (int w = 0; w < WORDS; w++) mask[w] |= w == word ? bits : 0u;
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

uint look_up(vec3 ab, vec3 bc, vec3 ca, bool positive, bool counting) {
  uint flip0, flip1, flip2, found = 0u;
  uint e0 = table_entry(ab, positive, flip0), e1 = table_entry(bc, positive, flip1), e2 = table_entry(ca, positive, flip2);
  // Words of an entry come four to a texel; a pass begins at a multiple of four.
  uint first = first_word >> 2u;
  [[unroll]] for (uint k = 0u; k < uint(WORDS + 3) / 4u; k++) {
    uint at = min(first + k, uint(TABLE_TEXELS) - 1u);
    uvec4 bits = (table_bits(e0 + at) ^ flip0) & (table_bits(e1 + at) ^ flip1) & (table_bits(e2 + at) ^ flip2);
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

// A triangle's half-spaces: what it hides is on the positive side of the planes through the view sample and its edges,
// and beyond its own.
struct HalfSpaces {
  vec3 ab, bc, ca, plane;
  float volume;
};

// Which of SG clusters from `first` on may hold a sample that is hidden and not known to be, and which hold none else:
// a bit each. Half-spaces are asked at the corners of the cluster's box, with more than rounding to spare.
uvec2 ask_clusters(HalfSpaces h, int first, bool counting) {
  if (!CLUSTERED || MOVE == 2u) return uvec2(0xffffffffu, 0u);
  int mine = min(first + int(gl_SubgroupInvocationID), LAST_CLUSTER);
  vec3 middle = texel(light_samples, uint(2 * SAMPLES + 2 * mine)).xyz;
  vec3 extent = texel(light_samples, uint(2 * SAMPLES + 2 * mine + 1)).xyz;
  vec3 nx = vec3(h.ab.x, h.bc.x, h.ca.x), ny = vec3(h.ab.y, h.bc.y, h.ca.y), nz = vec3(h.ab.z, h.bc.z, h.ca.z);
  uint may = 0u, all_ = 0u;
  [[unroll]] for (int k = 0; k < int(SG); k++) {
    vec3 d = vec3(subgroupShuffle(middle.x, uint(k)), subgroupShuffle(middle.y, uint(k)), subgroupShuffle(middle.z, uint(k))) - q;
    vec3 e = vec3(subgroupShuffle(extent.x, uint(k)), subgroupShuffle(extent.y, uint(k)), subgroupShuffle(extent.z, uint(k)));
    e += 2e-6 * (abs(d) + e);
    vec3 at = nx * d.x + ny * d.y + nz * d.z, reach = abs(nx) * e.x + abs(ny) * e.y + abs(nz) * e.z;
    float beyond = dot(h.plane, d) - h.volume, wide = dot(abs(h.plane), e) + 1e-6 * h.volume;
    vec3 most = at + reach, least_ = at - reach;
    bool meets = min(min(most.x, most.y), min(most.z, beyond + wide)) >= 0.0;
    bool inside = min(min(least_.x, least_.y), min(least_.z, beyond - wide)) > 0.0;
    may |= meets && !inside ? 1u << k : 0u;
    all_ |= inside ? 1u << k : 0u;
  }
  if (counting) return uvec2(may, all_);
  [[unroll]] for (int j = 0; j < int(SG) / 2; j++) {
    uint hidden = word_of_mask(first / 2 + j - int(first_word));
    may &= (hidden & 0xffffu) == 0xffffu ? ~(1u << (2 * j)) : 0xffffffffu;
    may &= (hidden >> 16u) == 0xffffu ? ~(2u << (2 * j)) : 0xffffffffu;
  }
  return uvec2(may, all_);
}

// Which of a cluster's samples are hidden.
uint evaluate_cluster(HalfSpaces h, int cluster) {
  uint bits = 0u;
  const int step_ = min(int(SG), CLUSTER);
  for (int k = 0; k < CLUSTER; k += step_) {
    int i = CLUSTER * cluster + k;
    vec4 mine = light_sample(i + int(gl_SubgroupInvocationID), 1);
    float place_u = MOVE == 2u ? light_sample(i + int(gl_SubgroupInvocationID), 0).w : 0.0;
    [[unroll]] for (int l = 0; l < step_; l++) {
      vec3 d = vec3(subgroupShuffle(mine.x, uint(l)), subgroupShuffle(mine.y, uint(l)), subgroupShuffle(mine.z, uint(l))) - q;
      if (MOVE == 2u)
        d.xy += wrapped(vec2(subgroupShuffle(place_u, uint(l)), subgroupShuffle(mine.w, uint(l)))) * vec2(side_u.w, side_v.w);
      precise float e0 = h.ab.x * d.x + h.ab.y * d.y + h.ab.z * d.z;
      precise float e1 = h.bc.x * d.x + h.bc.y * d.y + h.bc.z * d.z;
      precise float e2 = h.ca.x * d.x + h.ca.y * d.y + h.ca.z * d.z;
      bool hidden = e0 >= 0.0 && e1 >= 0.0 && e2 >= 0.0;
      bool beyond = dot(h.plane, d) > h.volume, owned = i + l < SAMPLES;
      bits |= hidden && beyond && owned ? 1u << (k + l) : 0u;
    }
    turns++;
  }
  return bits;
}

uint rasterise(vec3 a, vec3 b, vec3 c, uint rect, bool crossing, bool counting) {
  HalfSpaces h = HalfSpaces(edge_normal(a, b), edge_normal(b, c), edge_normal(c, a), edge_normal(b - a, c - a), 0.0);
  float volume = h.ab.x * c.x + h.ab.y * c.y + h.ab.z * c.z, s = volume < 0.0 ? -1.0 : 1.0;
  // After the volume: that is of the triangle, wherever the samples are turned.
  h = HalfSpaces(plane_of_set(h.ab), plane_of_set(h.bc), plane_of_set(h.ca), plane_of_set(h.plane), abs(volume));
  if (TABLE > 0 && !crossing) return look_up(h.ab, h.bc, h.ca, !(volume < 0.0), counting);
  h = HalfSpaces(h.ab * s, h.bc * s, h.ca * s, h.plane * s, h.volume);
  uint found = 0u;
  int first = int(first_word) * 2, end = min(first + 2 * WORDS, LAST_CLUSTER + 1);
  do {
    uvec2 asked = ask_clusters(h, first, counting);
    uint covered = or_of_all(asked.y), left = or_of_all(asked.x);
    left &= end - first < 32 ? (1u << (end - first)) - 1u : 0xffffffffu;
    left &= SG < 32u ? (1u << SG) - 1u : 0xffffffffu;
    if (covered != 0u)
      [[unroll]] for (int k = 0; k < int(SG); k++) {
        uint bits = (asked.y >> k & 1u) != 0u && first + k < end ? 0xffffu << (16 * (k & 1)) : 0u;
        int word = (first + k) / 2 - int(first_word);
        add_bits(word, bits);
        if (counting) found += counted(bits & owned_bits(word), word);
      }
    if (left != 0u) {
      do {
        int k = findLSB(left);
        left &= left - 1u;
        uint bits = evaluate_cluster(h, first + k);
        bits = (asked.x >> k & 1u) != 0u ? bits << (16 * (k & 1)) : 0u;
        int word = (first + k) / 2 - int(first_word);
        add_bits(word, bits);
        if (counting) found += counted(bits, word);
        turns++;
      } while (left != 0u);
    }
    first += int(SG);
    turns++;
  } while (first < end);
  return found;
}

// As the view sample takes it, working space.
vec3 sample_at(int i) {
  vec4 s = light_sample(32 * int(first_word) + i, 1);
  if (MOVE == 3u) return turned(s.xyz, 1.0);
  if (MOVE == 2u) return s.xyz + vec3(wrapped(vec2(light_sample(32 * int(first_word) + i, 0).w, s.w)) * vec2(side_u.w, side_v.w), 0.0);
  return s.xyz + (p - q);
}
