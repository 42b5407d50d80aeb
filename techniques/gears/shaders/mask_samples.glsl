// The visibility mask of any set of light samples, one bit each: every sample is held against the triangle's three edge
// half-spaces and its plane. Working space is the world, moved.
layout(constant_id = 1) const int SAMPLES = 1;
layout(constant_id = 4) const int WORDS = 1;
layout(constant_id = 5) const bool INFINITE = false;   // samples are directions

vec3 p;
vec3 group_lo, group_hi;
uint mask[WORDS];
float pad;
#include "techniques/common/shaders/hull_of_boxes.glsl"
Vec4s light_samples;

void begin_light(FrameConstants f, Vec4s samples) {
  light_samples = samples;
  vec3 lo = f.light_lo.xyz, hi = f.light_hi.xyz;
  grow_lo = INFINITE ? lo : lo - group_lo;
  grow_hi = INFINITE ? hi : hi - group_hi;
}

vec4 light_sample(int i) { return light_samples.at[min(i, SAMPLES - 1)]; }

// n, P in world space, light samples too.
void block_horizon(vec3 P, vec3 n, FrameConstants f) {
  vec3 from_light = P - f.apex.xyz;
  bool behind = f.front.w != 0.0 && dot(f.front.xyz, from_light) <= 0.0;
  behind = behind || (f.cone.w > -2.0 && dot(f.cone.xyz, from_light) < f.cone.w * length(from_light));
  for (int q = 0; q < WORDS; q++) {
    uint w = 0u;
    for (int k = 0; k < 32; k += int(SG)) {
      vec4 mine = light_sample(32 * q + k + int(gl_SubgroupInvocationID));
      for (int l = 0; l < int(SG); l++) {
        vec4 L = vec4(subgroupShuffle(mine.x, uint(l)), subgroupShuffle(mine.y, uint(l)), subgroupShuffle(mine.z, uint(l)), mine.w);
        vec3 d = L.xyz - (INFINITE ? vec3(0.0) : P);
        bool blocked = !(dot(n, d) > 0.0) || 32 * q + k + l >= SAMPLES;
        w |= blocked ? 1u << (k + l) : 0u;
      }
    }
    mask[q] = behind ? 0xffffffffu : w;
  }
}

bool may_hide(vec3 a, vec3 b, vec3 c, uint rect) { return true; }
void begin_mask() {}
void update_open() {}

bool touches(vec3 lo, vec3 hi, out uint rect) {
  rect = 0u;
  return meets_hull(lo, hi, INFINITE ? 1e30 : 1.0);
}

// A triangle's half-spaces: what it hides is on the positive side of its edges' planes through p and beyond its own.
struct Bounds {
  vec3 ab, bc, ca, plane;
  float volume;
};

Bounds bounds_of(vec3 a, vec3 b, vec3 c, bool crossing) {
  Bounds e = Bounds(edge_normal(a, b), edge_normal(b, c), edge_normal(c, a), edge_normal(b - a, c - a), 0.0);
  float volume = e.ab.x * c.x + e.ab.y * c.y + e.ab.z * c.z, s = volume < 0.0 ? -1.0 : 1.0;
  return Bounds(e.ab * s, e.bc * s, e.ca * s, e.plane * s, abs(volume));
}

uint fill_samples(Bounds e, bool counting) {
  uint found = 0u;
  int q = 0;
  do {
    uint w = 0u;
    for (int k = 0; k < min(32, SAMPLES); k += int(SG)) {
      vec4 mine = light_sample(32 * q + k + int(gl_SubgroupInvocationID));
      for (int l = 0; l < min(int(SG), SAMPLES); l++) {
        vec3 d = vec3(subgroupShuffle(mine.x, uint(l)), subgroupShuffle(mine.y, uint(l)), subgroupShuffle(mine.z, uint(l)));
        d = INFINITE ? d : d - sample_origin - p;
        precise float e0 = e.ab.x * d.x + e.ab.y * d.y + e.ab.z * d.z;
        precise float e1 = e.bc.x * d.x + e.bc.y * d.y + e.bc.z * d.z;
        precise float e2 = e.ca.x * d.x + e.ca.y * d.y + e.ca.z * d.z;
        bool hidden = e0 >= 0.0 && e1 >= 0.0 && e2 >= 0.0;
        hidden = hidden && (INFINITE || dot(e.plane, d) > e.volume) && 32 * q + k + l < SAMPLES;
        w |= hidden ? 1u << (k + l) : 0u;
        turns++;
      }
    }
    mask[q] |= w;
    if (counting) found += uint(bitCount(w));
    q++;
    turns++;
  } while (q < WORDS);
  return found;
}

uvec2 fill_rows(Bounds e, Bounds f, uint rect_e, uint rect_f, bool crossing, bool counting) {
  return uvec2(fill_samples(e, counting), fill_samples(f, counting));
}
