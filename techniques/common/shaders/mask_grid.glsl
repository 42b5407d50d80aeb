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
uint counted(uint bits, uint word) {
  if (ABOVE_HORIZON)
    [[unroll]] for (int q = 0; q < WORDS; q++) bits &= uint(q) == word ? ~below_horizon[q] : 0xffffffffu;
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
  // hx > 0: blocked up to column x; hx < 0: from column x on; else the whole row or nothing.
  bool from_x = hx < 0.0, flat_ = hx == 0.0;
  float inverse = -1.0 / (flat_ ? 1.0 : hx), direction = from_x ? -1.0 : 1.0, past = from_x ? float(PITCH) : 1.0;
  uint flip = from_x ? 0xffffffffu : 0u;
  [[unroll]] for (int q = 0; q < WORDS; q++) {
    uint w = 0u;
    [[unroll]] for (int r = 0; r < ROWS_PER_WORD; r++) {
      int row = PITCH > 32 ? q >> 1 : q * ROWS_PER_WORD + r;
      float v = h + hy * float(row), x = v * inverse;
      x = flat_ ? (v > 0.0 ? -2.0 : float(PITCH)) : x;
      // Truncation as in span(): columns up to x, or from x on.
      int n = int(lower(upper(x * direction + past, 0.0), float(PITCH)));
      n = from_x ? PITCH - n : n;
      uint bits = below(PITCH > 32 ? clamp(n - 32 * (q & 1), 0, 32) : n) ^ flip;
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
  uint columns = 0u, columns_high = 0u, rows = 0u, rows_high = 0u;
  [[unroll]] for (int b = 0; b < OPEN_BANDS; b++) open_[b] = 0u;
  [[unroll]] for (int q = 0; q < WORDS; q++) {
    uint u = or_of_all(~mask[q]);
    [[unroll]] for (int r = 0; r < ROWS_PER_WORD; r++) {
      int at = PITCH > 32 ? q >> 1 : q * ROWS_PER_WORD + r;
      uint row = PITCH >= 32 ? u : (u >> (r * PITCH)) & below(PITCH);
      if (PITCH <= 32) open_[q / WORDS_PER_OPEN_BAND] |= row;
      bool high = PITCH > 32 && (q & 1) == 1;
      columns |= high ? 0u : row;
      columns_high |= high ? row : 0u;
      rows |= row != 0u && at < 32 ? 1u << (at & 31) : 0u;
      rows_high |= row != 0u && at >= 32 ? 1u << (at & 31) : 0u;
    }
  }
  int c0 = columns != 0u ? findLSB(columns) : 32 + findLSB(columns_high);
  int c1 = columns_high != 0u ? 32 + findMSB(columns_high) : findMSB(columns);
  int r0 = rows != 0u ? findLSB(rows) : 32 + findLSB(rows_high);
  int r1 = rows_high != 0u ? 32 + findMSB(rows_high) : findMSB(rows);
  open_rect = vec4(float(c0), float(c1), float(r0), float(r1));
}

// False where no view sample of the group sees a light sample of the rectangle any more.
bool is_open(int i0, int i1, int j0, int j1) {
  if (PITCH > 32) return true;
  const int rows = WORDS_PER_OPEN_BAND * ROWS_PER_WORD;
  uint found = 0u;
  [[unroll]] for (int b = 0; b < OPEN_BANDS; b++) {
    bool after = j0 < (b + 1) * rows, before_ = j1 >= b * rows;   // no branches
    found |= after && before_ ? open_[b] : 0u;
  }
  return (found & below(i1 + 1) & ~below(i0)) != 0u;
}

// Rectangle of light samples that a box can hide from any view sample of the group, packed; false: none, and `rect` is
// nothing.
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
  // Within the mask where there is something; else anything.
  int a = int(i0), b = int(i1), c = int(j0), d = int(j1);
  rect = uint(a) | uint(b) << 8 | uint(c) << 16 | uint(d) << 24;
  bool open_left = is_open(a, b, c, d), columns_left = i0 <= i1, rows_left = j0 <= j1;   // no branches
  return above && columns_left && rows_left && open_left;
}

// What an edge (a, b) has on its sides: x, y are the least and the largest det(a - P, b - P, L - P) over all view samples
// P = group's middle + p', |p'| <= g, and light samples L = l + (u, v, 0), |(u, v)| <= h. It is linear in P and in L:
//   L . a x b - p' . (a - L) x (b - L), with a term of both. a, b, l from the group's middle; al, bl from l.
vec2 sides_of_edge(vec3 a, vec3 b, vec3 al, vec3 bl, vec3 l, vec2 h, vec3 g, vec3 both, float error) {
  vec3 n = cross(a, b), m = cross(al, bl), e = b - a;
  float middle = dot(l, n);
  float reach = h.x * abs(n.x) + h.y * abs(n.y) + dot(g, abs(m)) + dot(both, abs(e)) + error;
  return vec2(middle - reach, middle + reach);
}

// False when the triangle can hide no light sample of `rect` from any view sample of the group: its plane has all of
// them on one side, or no line between them passes between its edges. Lanes are triangles: what this leaves out need
// not be asked of each view sample. `error` is far above the rounding of bounds_of(), so that nothing on an edge is lost.
bool may_hide(vec3 a, vec3 b, vec3 c, uint rect) {
  vec2 lo = vec2(float(rect & 255u), float((rect >> 16) & 255u)), hi = vec2(float((rect >> 8) & 255u), float(rect >> 24));
  vec3 middle = 0.5 * (group_lo + group_hi), g = 0.5 * (group_hi - group_lo) + pad;
  vec2 h = 0.5 * (hi - lo) + reach_of_shift();
  vec3 at = vec3(0.5 * (lo + hi), 0.0), l = at - middle;
  vec3 al = a - at, bl = b - at, cl = c - at;
  a -= middle;
  b -= middle;
  c -= middle;
  vec3 both = vec3(g.z * h.y, g.z * h.x, g.x * h.y + g.y * h.x);
  vec3 size = abs(a) + abs(b) + abs(c), size_l = abs(l) + vec3(h, 0.0);
  float length_ = size.x + size.y + size.z, error = 4e-7 * length_ * length_ * (size_l.x + size_l.y + size_l.z);
  vec2 ab = sides_of_edge(a, b, al, bl, l, h, g, both, error);
  vec2 bc = sides_of_edge(b, c, bl, cl, l, h, g, both, error);
  vec2 ca = sides_of_edge(c, a, cl, al, l, h, g, both, error);
  bool some_below = lower(lower(ab.y, bc.y), ca.y) < 0.0, some_above = upper(upper(ab.x, bc.x), ca.x) > 0.0;
  vec3 n = cross(b - a, c - a);
  float of_group = -dot(n, a), of_light = -dot(n, al), slack = 4e-7 * length_ * length_ * length_;
  float group_reach = dot(g, abs(n)) + slack, light_reach = h.x * abs(n.x) + h.y * abs(n.y) + slack;
  bool below_ = of_group < -group_reach && of_light < -light_reach;
  bool above = of_group > group_reach && of_light > light_reach;
  bool passes = !some_below || !some_above;
  return passes && !below_ && !above;
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

// The rows of a rectangle, and what it keeps of words that share rows outside it. Unsigned: a division is a shift.
struct Rows {
  float c0, c1;
  uint j0, j1, first_word, last_word, before, after;
};

Rows rows_of(uint rect) {
  const uint in_word = uint(ROWS_PER_WORD);
  Rows r;
  r.c0 = float(rect & 255u);
  r.c1 = float((rect >> 8) & 255u);
  r.j0 = (rect >> 16) & 255u;
  r.j1 = rect >> 24;
  r.first_word = r.j0 / in_word;
  r.last_word = r.j1 / in_word;
  r.before = 0xffffffffu << ((r.j0 % in_word) * uint(PITCH));
  r.after = 0xffffffffu >> ((in_word - 1u - r.j1 % in_word) * uint(PITCH));
  return r;
}

// Columns of row j within the bounds: their bits in word `part` of the row are span(x, y, part).
vec2 columns_of(Bounds e, Rows r, float j, bool crossing) {
  float x0 = upper(e.lo_slope * j + e.lo_offset), x1 = lower(e.hi_slope * j + e.hi_offset);
  if (crossing) {
    x0 = upper(x0, e.lo4_slope * j + e.lo4_offset);
    x1 = lower(x1, e.hi4_slope * j + e.hi4_offset);
  }
  return vec2(lower(upper(x0, r.c0), float(PITCH)), upper(lower(x1, r.c1), -1.0));
}

// Of the bits in a word those in rows of the rectangle.
uint within(Rows r, uint bits, uint word) {
  if (ROWS_PER_WORD > 1) {
    if (BAND_WORDS > 1) bits = word < r.first_word || word > r.last_word ? 0u : bits;
    bits &= word == r.first_word ? r.before : 0xffffffffu;
    return bits & (word == r.last_word ? r.after : 0xffffffffu);
  }
  uint row = PITCH > 32 ? word / 2u : word;
  return row < r.j0 || row > r.j1 ? 0u : bits;
}

// Sets in each view sample's mask the light samples of two triangles' rectangles within their bounds. Two at a time, since
// what one triangle takes depends on itself from end to end, and a processor that waits for it does the other meanwhile.
// Returns the numbers of light samples found (whether or not hidden before) where `counting`, else 0.
uvec2 fill_rows(Bounds e, Bounds f, uint rect_e, uint rect_f, bool crossing, bool counting) {
  Rows r = rows_of(rect_e), s = rows_of(rect_f);
  uint band = min(r.j0, s.j0) / uint(BAND_ROWS), last = max(r.j1, s.j1) / uint(BAND_ROWS);
  uvec2 found = uvec2(0u);
  turns += last - band + 1u;
  do {
    uint w[BAND_WORDS], x[BAND_WORDS];
    float top = float(band * uint(BAND_ROWS));
    [[unroll]] for (int k = 0; k < BAND_WORDS; k++) w[k] = x[k] = 0u;
    [[unroll]] for (int k = 0; k < BAND_ROWS; k++) {
      vec2 ce = columns_of(e, r, top + float(k), crossing), cf = columns_of(f, s, top + float(k), crossing);
      if (PITCH > 32) {
        w[2 * k] = span(ce.x, ce.y, 0);
        w[2 * k + 1] = span(ce.x, ce.y, 1);
        x[2 * k] = span(cf.x, cf.y, 0);
        x[2 * k + 1] = span(cf.x, cf.y, 1);
      } else {
        w[k / ROWS_PER_WORD] |= span(ce.x, ce.y, 0) << ((k % ROWS_PER_WORD) * PITCH);
        x[k / ROWS_PER_WORD] |= span(cf.x, cf.y, 0) << ((k % ROWS_PER_WORD) * PITCH);
      }
    }
    [[unroll]] for (int k = 0; k < BAND_WORDS; k++) {
      uint word = band * uint(BAND_WORDS) + uint(k);
      w[k] = within(r, w[k], word);
      x[k] = within(s, x[k], word);
      if (counting) found += uvec2(counted(w[k], word), counted(x[k], word));
      w[k] |= x[k];
    }
    // Constant places and a comparison, not mask[band]: a place that varies costs a scalar load and store per lane.
    [[unroll]] for (int q = 0; q < WORDS; q++) mask[q] = band == uint(q / BAND_WORDS) ? mask[q] | w[q % BAND_WORDS] : mask[q];
    band++;
  } while (band <= last);
  return found;
}

// Of one triangle, all in one.
uint rasterise(vec3 a, vec3 b, vec3 c, uint rect, bool crossing, bool counting) {
  Bounds e = bounds_of(a, b, c, crossing);
  return fill_rows(e, e, rect, rect, crossing, counting).x;
}
