// The visibility mask of any set of light samples, one bit each: WORDS words of it at a time, from pc.first_word on.
// Every sample is held against the triangle's three edge half-spaces and its plane; with a lookup table, the samples
// behind each plane are looked up [Sintorn2008, sec. 4.2].
layout(constant_id = 1) const int SAMPLES = 1;   // of the whole set
layout(constant_id = 4) const int WORDS = 1;
layout(constant_id = 5) const int TABLE = 0;     // entries along each axis; 0: planes are evaluated exactly
layout(constant_id = 15) const int TABLE_TEXELS = 1;

layout(set = 0, binding = 6) uniform sampler2D light_samples;    // SAMPLES in the world, then in working space
layout(set = 0, binding = 7) uniform usampler2D table;           // TABLE_TEXELS per entry

vec3 p;
vec3 group_lo, group_hi;
uint mask[WORDS];
float pad, table_radius;   // table_radius: of the samples about the centre
vec3 light_middle, light_extent;
#include "techniques/common/shaders/hull_of_boxes.glsl"
uint first_word;

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
  [[unroll]] for (int q = 0; q < WORDS; q++) {
    uint w = 0u;
    for (int k = 0; k < 32; k += int(SG)) {
      int i = 32 * (int(first_word) + q) + k;
      vec4 mine = light_sample(i + int(gl_SubgroupInvocationID), 0);
      for (int l = 0; l < int(SG); l++) {
        vec3 L = vec3(subgroupShuffle(mine.x, uint(l)), subgroupShuffle(mine.y, uint(l)), subgroupShuffle(mine.z, uint(l)));
        bool blocked = !(dot(n, L - P) > 0.0), past = i + l >= SAMPLES;
        w |= blocked || past ? 1u << (k + l) : 0u;
      }
    }
    mask[q] = behind ? 0xffffffffu : w;
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
  float size = float(TABLE), distance_ = dot(n, p) / table_radius;
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
      if (counting) found += uint(bitCount(bits[j]));
    }
  }
  return found;
}

uint rasterise(vec3 a, vec3 b, vec3 c, uint rect, bool crossing, bool counting) {
  vec3 ab = edge_normal(a, b), bc = edge_normal(b, c), ca = edge_normal(c, a), plane = edge_normal(b - a, c - a);
  float volume = ab.x * c.x + ab.y * c.y + ab.z * c.z, s = volume < 0.0 ? -1.0 : 1.0;
  if (TABLE > 0 && !crossing) return look_up(ab, bc, ca, !(volume < 0.0), counting);
  ab *= s;
  bc *= s;
  ca *= s;
  plane *= s;
  volume = abs(volume);
  uint found = 0u;
  int q = 0;
  do {
    uint w = 0u;
    for (int k = 0; k < 32; k += int(SG)) {
      int i = 32 * (int(first_word) + q) + k;
      vec4 mine = light_sample(i + int(gl_SubgroupInvocationID), 1);
      [[unroll]] for (int l = 0; l < int(SG); l++) {
        vec3 d = vec3(subgroupShuffle(mine.x, uint(l)), subgroupShuffle(mine.y, uint(l)), subgroupShuffle(mine.z, uint(l))) - p;
        precise float e0 = ab.x * d.x + ab.y * d.y + ab.z * d.z;
        precise float e1 = bc.x * d.x + bc.y * d.y + bc.z * d.z;
        precise float e2 = ca.x * d.x + ca.y * d.y + ca.z * d.z;
        bool hidden = e0 >= 0.0 && e1 >= 0.0 && e2 >= 0.0;
        bool beyond = dot(plane, d) > volume, owned = i + l < SAMPLES;
        w |= hidden && beyond && owned ? 1u << (k + l) : 0u;
      }
      turns++;
    }
    add_bits(q, w);
    if (counting) found += uint(bitCount(w));
    q++;
    turns++;
  } while (q < WORDS);
  return found;
}

vec3 sample_at(int i) { return light_sample(32 * int(first_word) + i, 1).xyz; }
