// The visibility mask of a regular grid of light samples: COLUMNS x ROWS, light sample (i, j) at (i, j, 0) of working
// space. A row takes PITCH bits (a power of two >= COLUMNS) of a word, or two words where PITCH is 64; what no light
// sample owns stays 1, so that a full mask is all ones.
layout(constant_id = 1) const int COLUMNS = 16;
layout(constant_id = 2) const int ROWS = 16;
layout(constant_id = 3) const int PITCH = 16;
layout(constant_id = 4) const int WORDS = 8;
layout(constant_id = 14) const int BAND_WORDS = 1;   // words of the mask that one turn of the row loop fills
layout(constant_id = 21) const bool ABOVE_HORIZON = false;  // counts leave out what is below the horizon
layout(constant_id = 20) const uint MOVE = 0;        // 1: each view sample's light samples are moved by its `shift`
const int ROWS_PER_WORD = PITCH >= 32 ? 1 : 32 / PITCH;
const int BAND_ROWS = PITCH > 32 ? BAND_WORDS / 2 : BAND_WORDS * ROWS_PER_WORD;
const float far_away = 1e30;

#include "samples/shaders/light_rotation.h"
vec3 p;                     // view sample
vec2 shift;                 // columns and rows, at most half of one to each side: light sample (i, j) is at (i, j) + shift
float reach_of_shift() { return MOVE != 0u ? 0.5 : 0.0; }
void begin_shift(uint pixel, FrameConstants f) {
  uint seed = uint(f.first.w);
  shift = MOVE != 0u ? vec2(rotation_unit(pixel, seed, 0u), rotation_unit(pixel, seed, 1u)) - 0.5 : vec2(0.0);
}
// The view sample as whole columns and rows see it.
vec2 unshifted() { return MOVE != 0u ? p.xy - shift : p.xy; }
vec3 group_lo, group_hi;    // box of the group's view samples
uint mask[WORDS];
// Columns in which some view sample of the group still sees a light sample, per band of rows. Bands, since the question
// is asked for every box and triangle: all words of a mask would cost more than their finer rows save.
const int WORDS_PER_OPEN_BAND = (WORDS + 7) / 8, OPEN_BANDS = (WORDS + WORDS_PER_OPEN_BAND - 1) / WORDS_PER_OPEN_BAND;
uint open_[OPEN_BANDS];
vec4 open_rect;             // their columns (x, y) and rows (z, w)
float pad;

// Blocked from the start: no part in counts where ABOVE_HORIZON.
uint below_horizon[WORDS];
uint counted(uint bits, int word) {
  if (ABOVE_HORIZON)
    [[unroll]] for (int q = 0; q < WORDS; q++) bits &= q == word ? ~below_horizon[q] : 0xffffffffu;
  return uint(bitCount(bits));
}

// Bits below n, 0 <= n <= 32.
uint below(int n) { return PITCH < 32 ? (1u << n) - 1u : (n >= 32 ? 0xffffffffu : (1u << n) - 1u); }

// Bits of the columns in [lo, hi] for word `part` of a row; 0 <= lo <= PITCH, -1 <= hi < PITCH. Truncation instead of
// floor and ceiling: the sums are exact at integers and monotone, so that no column on a bound is lost.
uint span(float lo, float hi, int part) {
  int past = int(hi + 1.0), from_end = int(float(PITCH) - lo);   // columns up to hi; columns from lo on
  if (PITCH > 32) {
    past = clamp(past - 32 * part, 0, 32);
    return below(past) & ~below(clamp(PITCH - from_end - 32 * part, 0, 32));
  }
  return below(past) & ~(PITCH == 32 && from_end >= 32 ? 0u : below(PITCH) >> from_end);
}

// Light samples that a view sample at P with normal n does not face, or that face away from it, are blocked.
void block_horizon(vec3 P, vec3 n, FrameConstants f) {
  bool behind = dot(f.light.row_z.xyz, P - f.light.origin.xyz) <= 0.0;
  float h = dot(n, f.first.xyz - P), hx = dot(n, f.step_u.xyz), hy = dot(n, f.step_v.xyz);
  if (MOVE != 0u) h += hx * shift.x + hy * shift.y;
  float inverse = -1.0 / (hx == 0.0 ? 1.0 : hx);
  [[unroll]] for (int q = 0; q < WORDS; q++) {
    uint w = 0u;
    [[unroll]] for (int r = 0; r < ROWS_PER_WORD; r++) {
      int row = PITCH > 32 ? q >> 1 : q * ROWS_PER_WORD + r;
      float v = h + hy * float(row), x = clamp(v * inverse, -2.0, float(PITCH) + 1.0);
      // hx > 0: blocked up to x; hx < 0: blocked from x on; else the whole row or nothing.
      float lo = hx < 0.0 ? x : 0.0, hi = hx > 0.0 ? x : float(PITCH - 1);
      hi = hx == 0.0 && v > 0.0 ? -1.0 : hi;
      uint bits = span(clamp(lo, 0.0, float(PITCH)), clamp(hi, -1.0, float(PITCH - 1)), q & 1);
      uint owned = row < ROWS ? span(0.0, float(COLUMNS - 1), q & 1) : 0u;
      bits |= ~owned;
      w |= PITCH >= 32 ? bits : (bits & below(PITCH)) << (r * PITCH);
    }
    mask[q] = behind ? 0xffffffffu : w;
  }
}

void begin_mask() {
  open_rect = vec4(0.0, float(COLUMNS - 1), 0.0, float(ROWS - 1));
  [[unroll]] for (int b = 0; b < OPEN_BANDS; b++) open_[b] = 0xffffffffu;
}

void update_open() {
  uint columns = 0u, columns_high = 0u;
  float r0 = 1e3, r1 = -1.0;
  [[unroll]] for (int b = 0; b < OPEN_BANDS; b++) open_[b] = 0u;
  [[unroll]] for (int q = 0; q < WORDS; q++) {
    uint u = or_of_all(~mask[q]);
    if (PITCH > 32) {
      columns |= (q & 1) == 0 ? u : 0u;
      columns_high |= (q & 1) == 1 ? u : 0u;
      r0 = lower(r0, u != 0u ? float(q >> 1) : 1e3);
      r1 = u != 0u ? float(q >> 1) : r1;
    } else {
      [[unroll]] for (int r = 0; r < ROWS_PER_WORD; r++) {
        uint row = PITCH == 32 ? u : (u >> (r * PITCH)) & below(PITCH);
        open_[q / WORDS_PER_OPEN_BAND] |= row;
        columns |= row;
        float at = float(q * ROWS_PER_WORD + r);
        r0 = lower(r0, row != 0u ? at : 1e3);
        r1 = row != 0u ? at : r1;
      }
    }
  }
  int c0 = columns != 0u ? findLSB(columns) : 32 + findLSB(columns_high);
  int c1 = columns_high != 0u ? 32 + findMSB(columns_high) : findMSB(columns);
  open_rect = vec4(float(c0), float(c1), r0, r1);
}

// False where no view sample of the group sees a light sample of the rectangle any more.
bool is_open(int i0, int i1, int j0, int j1) {
  if (PITCH > 32) return true;
  const int rows = WORDS_PER_OPEN_BAND * ROWS_PER_WORD;
  int b0 = j0 / rows, b1 = j1 / rows;
  uint found = 0u;
  [[unroll]] for (int b = 0; b < OPEN_BANDS; b++) {
    bool inside = b >= b0, before_end = b <= b1;
    found |= inside && before_end ? open_[b] : 0u;
  }
  return (found & below(i1 + 1) & ~below(i0)) != 0u;
}

// Rectangle of light samples that a box can hide from any view sample of the group, packed; false: none.
//
// A point q hides from p the light plane's point q s + p (1 - s), s = p.z / (p.z - q.z) >= 1 for q above the plane of
// the light; per axis it is extreme at the ends of s. Padded before the magnification by s. What reaches down to the
// view samples' own height may hide anything on its side.
bool touches(vec3 lo, vec3 hi, out uint rect) {
  float z0 = upper(lo.z, 0.0);
  bool above = z0 < group_hi.z;
  float s0 = group_hi.z / (group_hi.z - z0 + pad), rest = group_lo.z - hi.z - pad;
  float s1 = rest > pad ? group_lo.z / rest : far_away;
  float t0 = s0 - 1.0;
  vec2 nearer_lo = lo.xy * s0 - group_hi.xy * t0, nearer_hi = hi.xy * s0 - group_lo.xy * t0;
  vec2 further_lo = (lo.xy - group_hi.xy - 2.0 * pad) * s1 + group_hi.xy;
  vec2 further_hi = (hi.xy - group_lo.xy + 2.0 * pad) * s1 + group_lo.xy;
  float slack = 0.01 + reach_of_shift();
  float i0 = ceil(upper(lower(nearer_lo.x, further_lo.x) - slack, open_rect.x));
  float i1 = floor(lower(upper(nearer_hi.x, further_hi.x) + slack, open_rect.y));
  float j0 = ceil(upper(lower(nearer_lo.y, further_lo.y) - slack, open_rect.z));
  float j1 = floor(lower(upper(nearer_hi.y, further_hi.y) + slack, open_rect.w));
  int a = int(clamp(i0, 0.0, float(COLUMNS - 1))), b = int(clamp(i1, 0.0, float(COLUMNS - 1)));
  int c = int(clamp(j0, 0.0, float(ROWS - 1))), d = int(clamp(j1, 0.0, float(ROWS - 1)));
  rect = uint(a) | uint(b) << 8 | uint(c) << 16 | uint(d) << 24;
  bool open_left = is_open(a, b, c, d), columns_left = i0 <= i1, rows_left = j0 <= j1;   // no branches
  return above && columns_left && rows_left && open_left;
}

// False when the triangle's plane has the light and all view samples of the group on one side, so that it can hide
// nothing: a quick end for the ground's large triangles, which reach through the light's plane.
bool separates(vec3 a, vec3 b, vec3 c) {
  vec3 n = edge_normal(b - a, c - a);
  vec3 lo = n * (group_lo - a - pad), hi = n * (group_hi - a + pad);
  float below_ = dot(lower(lo, hi), vec3(1.0)), above = dot(upper(lo, hi), vec3(1.0));
  vec3 wider = vec3(reach_of_shift(), reach_of_shift(), 0.0);
  vec3 l0 = n * (-wider - a - pad), l1 = n * (vec3(float(COLUMNS - 1), float(ROWS - 1), 0.0) + wider - a + pad);
  float light_below = dot(lower(l0, l1), vec3(1.0)), light_above = dot(upper(l0, l1), vec3(1.0));
  float error = 1e-5 * (abs(below_) + abs(above) + abs(light_below) + abs(light_above));
  return !((below_ > error && light_below > error) || (above < -error && light_above < -error));
}

// Of a triangle's half-spaces on the columns of row j: column >= lo_slope j + lo_offset, <= hi_slope j + hi_offset. The
// fourth is there for triangles that cross the light's plane.
struct Bounds {
  vec3 lo_slope, lo_offset, hi_slope, hi_offset;
  float lo4_slope, lo4_offset, hi4_slope, hi4_offset;
};

const float least = 1e-20;

// Of triangle (a, b, c); corners relative to p. `crossing`: it crosses the light's plane; a fourth half-space keeps what
// lies beyond the light out.
Bounds bounds_of(vec3 a, vec3 b, vec3 c, bool crossing) {
  a.z = -a.z;
  b.z = -b.z;
  c.z = -c.z;
  vec3 ab = edge_normal(a, b), bc = edge_normal(b, c), ca = edge_normal(c, a);
  vec3 nx = vec3(ab.x, bc.x, ca.x), ny = vec3(ab.y, bc.y, ca.y), nz = vec3(ab.z, bc.z, ca.z);
  float volume = ab.x * c.x + ab.y * c.y + ab.z * c.z;
  uint side = floatBitsToUint(volume) & 0x80000000u;
  // Edge value at light sample (i, j): nx (i - p.x) + ny (j - p.y) + nz p.z. Solved for i; a tiny nx keeps its sign.
  uvec3 sign_ = floatBitsToUint(nx) & 0x80000000u;
  vec3 inverse = -1.0 / mix(nx, uintBitsToFloat(sign_ | floatBitsToUint(least)), lessThan(abs(nx), vec3(least)));
  vec2 at = unshifted();
  vec3 slope = ny * inverse, offset = (nz * p.z) * inverse - slope * at.y + at.x;
  bvec3 upper_bound = notEqual(sign_ ^ side, uvec3(0u));
  Bounds e;
  e.lo_slope = mix(slope, vec3(0.0), upper_bound);
  e.lo_offset = mix(offset, vec3(-far_away), upper_bound);
  e.hi_slope = mix(vec3(0.0), slope, upper_bound);
  e.hi_offset = mix(vec3(far_away), offset, upper_bound);
  e.lo4_slope = 0.0;
  e.lo4_offset = -far_away;
  e.hi4_slope = 0.0;
  e.hi4_offset = far_away;
  if (crossing) {
    vec3 n = edge_normal(b - a, c - a);
    uint s = floatBitsToUint(n.x) & 0x80000000u;
    float inv = -1.0 / (abs(n.x) < least ? uintBitsToFloat(s | floatBitsToUint(least)) : n.x);
    float m = n.y * inv, o = (n.z * p.z - dot(n, a)) * inv - m * at.y + at.x;
    bool is_upper = (s ^ side) != 0u;
    e.lo4_slope = is_upper ? 0.0 : m;
    e.lo4_offset = is_upper ? -far_away : o;
    e.hi4_slope = is_upper ? m : 0.0;
    e.hi4_offset = is_upper ? o : far_away;
  }
  return e;
}

// False when no row of `rect` has a column that keeps to the bounds: they are monotone in j, so the ends of the range of
// rows tell, by the same roundings as span().
bool may_cover(Bounds e, uint rect) {
  float j0 = float((rect >> 16) & 255u), j1 = float(rect >> 24);
  float x0 = upper(lower(e.lo_slope * j0 + e.lo_offset, e.lo_slope * j1 + e.lo_offset));
  float x1 = lower(upper(e.hi_slope * j0 + e.hi_offset, e.hi_slope * j1 + e.hi_offset));
  x0 = lower(upper(x0, float(rect & 255u)), float(PITCH));
  x1 = upper(lower(x1, float((rect >> 8) & 255u)), -1.0);
  return int(x1 + 1.0) + int(float(PITCH) - x0) > PITCH;
}

// Sets in each view sample's mask the light samples of `rect` within the bounds; `some`: there may be any.
// Returns the number of light samples found (whether or not hidden before) where `counting`, else 0.
uint fill_rows(Bounds e, uint rect, bool some, bool crossing, bool counting) {
  float c0 = float(rect & 255u), c1 = float((rect >> 8) & 255u);
  int j0 = int((rect >> 16) & 255u), j1 = int(rect >> 24);
  // Rows outside [j0, j1] that share a word with rows inside.
  int first_word = j0 / ROWS_PER_WORD, last_word = j1 / ROWS_PER_WORD;
  uint before = (0xffffffffu << ((j0 - first_word * ROWS_PER_WORD) * PITCH)), after = 0xffffffffu >> ((ROWS_PER_WORD - 1 - (j1 - last_word * ROWS_PER_WORD)) * PITCH);
  int band = j0 / BAND_ROWS, last = some ? j1 / BAND_ROWS : band;
  uint found = 0u;
  turns += uint(last - band + 1);
  do {
    uint w[BAND_WORDS];
    float top = float(band * BAND_ROWS);
    [[unroll]] for (int k = 0; k < BAND_WORDS; k++) w[k] = 0u;
    [[unroll]] for (int r = 0; r < BAND_ROWS; r++) {
      float j = top + float(r);
      float x0 = upper(e.lo_slope * j + e.lo_offset), x1 = lower(e.hi_slope * j + e.hi_offset);
      if (crossing) {
        x0 = upper(x0, e.lo4_slope * j + e.lo4_offset);
        x1 = lower(x1, e.hi4_slope * j + e.hi4_offset);
      }
      x0 = lower(upper(x0, c0), float(PITCH));
      x1 = upper(lower(x1, c1), -1.0);
      if (PITCH > 32) {
        w[2 * r] = span(x0, x1, 0);
        w[2 * r + 1] = span(x0, x1, 1);
      } else {
        w[r / ROWS_PER_WORD] |= span(x0, x1, 0) << ((r % ROWS_PER_WORD) * PITCH);
      }
    }
    [[unroll]] for (int k = 0; k < BAND_WORDS; k++) {
      if (ROWS_PER_WORD > 1) {
        int word = band * BAND_WORDS + k;
        if (BAND_WORDS > 1) w[k] = word < first_word || word > last_word ? 0u : w[k];
        w[k] &= word == first_word ? before : 0xffffffffu;
        w[k] &= word == last_word ? after : 0xffffffffu;
      } else {
        int row = PITCH > 32 ? band * BAND_ROWS + k / 2 : band * BAND_ROWS + k;
        w[k] = row < j0 || row > j1 ? 0u : w[k];
      }
      if (counting) found += counted(w[k], band * BAND_WORDS + k);
    }
    // Constant places and a comparison, not mask[band]: a place that varies costs a scalar load and store per lane.
    [[unroll]] for (int q = 0; q < WORDS; q++) mask[q] |= band == q / BAND_WORDS ? w[q % BAND_WORDS] : 0u;
    band++;
  } while (band <= last);
  return found;
}

// Both in one, for triangles that are seldom missed.
uint rasterise(vec3 a, vec3 b, vec3 c, uint rect, bool crossing, bool counting) {
  return fill_rows(bounds_of(a, b, c, crossing), rect, true, crossing, counting);
}
