// Triangles as a view sample sees them against a grid of light samples: per instruction set. Nothing that
// decides a bit uses a fused multiply-add or an approximate reciprocal, so that every instruction set gives
// the same masks.
#if defined(PENUMBRA_GEARS_CPU_PROJECTION) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_GEARS_CPU_PROJECTION
#undef PENUMBRA_GEARS_CPU_PROJECTION
#else
#define PENUMBRA_GEARS_CPU_PROJECTION
#endif
#include <algorithm>

#include "techniques/gears/cpu_boxes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::gears::cpu::HWY_NAMESPACE {

struct Vector3 {
  Vector x, y, z;
};
HWY_INLINE Vector3 minus(const Vector3& a, const Vector3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
// The normal of the plane through P and the edge from a to b, both relative to P: unfused, so that b x a is
// the exact negative and two triangles cannot both miss a direction through their common edge.
HWY_INLINE Vector3 edge_normal(const Vector3& a, const Vector3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Vector dot3(const Vector3& a, const Vector3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

// A half-space on the rows of a grid: column >= slope row + offset, or <= where `upper`.
struct Bound {
  Vector slope, offset;
  Mask upper;
};
inline constexpr float least = 1e-20F;

// nx (i - px) + ny (j - py) + constant = 0, solved for column i of row j; a tiny nx keeps its sign.
HWY_INLINE Bound bound_of(Vector nx, Vector ny, Vector constant, Vector volume, const ViewPoint& p) {
  const Vector not_zero = hn::IfThenElse(hn::Lt(hn::Abs(nx), set(least)), hn::CopySign(set(least), nx), nx);
  const Vector inverse = hn::Div(set(-1), not_zero), slope = hn::Mul(ny, inverse);
  const Vector offset = hn::Add(hn::Sub(hn::Mul(constant, inverse), hn::Mul(slope, set(p.y))), set(p.x));
  return {slope, offset, sign_bit(hn::Xor(nx, volume))};
}

// Triangles before a view sample, lane by lane: `use` tells which may hide light samples, all of them in the
// rows and columns given, inclusive, and inside the half-spaces.
template <int edges>
struct Projection {
  Vector c0, c1, r0, r1;
  Mask use;
  Bound bounds[edges];
};

// `crossing`: triangles that may cross the light's plane have a fourth half-space, their own plane's.
template <bool crossing>
inline constexpr int edges_of = crossing ? 4 : 3;

// The triangles from `first` on of a block. False: none hides anything, and the half-spaces are not made.
template <bool crossing>
HWY_INLINE bool project(const Block& block, std::size_t first, const ViewPoint& p, const LightView& light,
                        Projection<edges_of<crossing>>& out) {
  const Floats d;
  const Vector px = set(p.x), py = set(p.y), pz = set(p.z), zero = hn::Zero(d);
  const float rounding = 0.01F + 2e-6F * (std::abs(p.x) + std::abs(p.y));
  const auto corner = [&](Corner x) HWY_ATTR {
    // z is the height above P, towards the light.
    return Vector3{hn::Sub(hn::Load(d, block.v[x] + first), px),
                   hn::Sub(hn::Load(d, block.v[x + 1] + first), py),
                   hn::Sub(pz, hn::Load(d, block.v[x + 2] + first))};
  };
  const Vector3 a = corner(ax), b = corner(bx), c = corner(cx);
  out.use = hn::Gt(hn::Max(hn::Max(a.z, b.z), c.z), zero);
  if (hn::AllFalse(d, out.use)) return false;
  // The rectangle of light samples around the triangle's projection; all, where a corner is not above P.
  const Mask straddles = hn::Le(hn::Min(hn::Min(a.z, b.z), c.z), set(light.pad));
  // Pz over each height, by one division.
  const Vector bc_z = hn::Mul(b.z, c.z), scale = hn::Div(pz, hn::Mul(a.z, bc_z)),
               a_scale = hn::Mul(a.z, scale);
  const Vector s_a = hn::Mul(bc_z, scale), s_b = hn::Mul(a_scale, c.z), s_c = hn::Mul(a_scale, b.z);
  const auto range = [&](Vector u_a, Vector u_b, Vector u_c, Vector from, int count, Vector* first_one,
                         Vector* last_one) HWY_ATTR {
    const Vector v_a = hn::Mul(u_a, s_a), v_b = hn::Mul(u_b, s_b), v_c = hn::Mul(u_c, s_c);
    const Vector end = set(static_cast<float>(count - 1));
    const Vector lo = hn::Add(hn::Min(hn::Min(v_a, v_b), v_c), hn::Sub(from, set(rounding)));
    const Vector hi = hn::Add(hn::Max(hn::Max(v_a, v_b), v_c), hn::Add(from, set(rounding)));
    *first_one = hn::IfThenZeroElse(straddles, hn::Ceil(hn::Max(lo, zero)));
    *last_one = hn::IfThenElse(straddles, end, hn::Floor(hn::Min(hi, end)));
  };
  range(a.x, b.x, c.x, px, light.columns, &out.c0, &out.c1);
  range(a.y, b.y, c.y, py, light.rows, &out.r0, &out.r1);
  out.use = hn::And(out.use, hn::And(hn::Le(out.c0, out.c1), hn::Le(out.r0, out.r1)));
  if (hn::AllFalse(d, out.use)) return false;

  const Vector3 ab = edge_normal(a, b), bc = edge_normal(b, c), ca = edge_normal(c, a);
  const Vector volume = dot3(ab, c);
  out.bounds[0] = bound_of(ab.x, ab.y, hn::Mul(ab.z, pz), volume, p);
  out.bounds[1] = bound_of(bc.x, bc.y, hn::Mul(bc.z, pz), volume, p);
  out.bounds[2] = bound_of(ca.x, ca.y, hn::Mul(ca.z, pz), volume, p);
  if constexpr (crossing) {
    const Vector3 n = edge_normal(minus(b, a), minus(c, a));
    out.bounds[3] = bound_of(n.x, n.y, hn::Sub(hn::Mul(n.z, pz), dot3(n, a)), volume, p);
  }
  return true;
}

// Triangles set down in memory, to be taken one at a time. A half-space bounds one side of a row's columns;
// on the other side its offset is infinite, so that it bounds nothing.
template <int edges>
struct alignas(64) Spans {
  float slope[edges][block_size], from[edges][block_size], to[edges][block_size];
  float first_column[block_size], last_column[block_size], first_row[block_size], last_row[block_size];
};
template <int edges>
HWY_INLINE void set_down(const Projection<edges>& t, Spans<edges>& out) {
  const Floats d;
  const Vector infinite = set(INFINITY);
  for (int k = 0; k < edges; ++k) {
    const Bound& b = t.bounds[k];
    hn::Store(b.slope, d, out.slope[k]);
    hn::Store(hn::IfThenElse(b.upper, hn::Neg(infinite), b.offset), d, out.from[k]);
    hn::Store(hn::IfThenElse(b.upper, b.offset, infinite), d, out.to[k]);
  }
  hn::Store(t.c0, d, out.first_column), hn::Store(t.c1, d, out.last_column);
  hn::Store(t.r0, d, out.first_row), hn::Store(t.r1, d, out.last_row);
}

// The columns [from, to], whole numbers, that a triangle covers of each of some rows: lanes are rows.
struct Columns {
  Vector from, to;
};
template <int edges>
HWY_INLINE Columns columns_of(const Spans<edges>& t, std::size_t lane, Vector row) {
  Vector from = set(t.first_column[lane]), to = set(t.last_column[lane]);
  for (int k = 0; k < edges; ++k) {
    const Vector along = hn::Mul(set(t.slope[k][lane]), row);
    from = hn::Max(from, hn::Add(along, set(t.from[k][lane])));
    to = hn::Min(to, hn::Add(along, set(t.to[k][lane])));
  }
  return {hn::Ceil(from), hn::Floor(to)};
}

// A whole number from 0 to 63, read off the mantissa.
HWY_INLINE hn::Vec<Words> small_integer(Vector v) {
  const Words du;
  return hn::And(hn::BitCast(du, hn::Add(v, set(0x1p23F))), hn::Set(du, 63));
}

// The bits of columns in a part of 32; only where `some`.
HWY_INLINE hn::Vec<Words> bits_of_columns(const Columns& c, std::size_t part, Mask* some) {
  const Floats d;
  const Vector base = set(static_cast<float>(32 * part)), last = set(31);
  const Vector lo = hn::Max(hn::Sub(c.from, base), hn::Zero(d)), hi = hn::Min(hn::Sub(c.to, base), last);
  *some = hn::And(*some, hn::Le(lo, hi));
  const auto ones = hn::Set(Words(), ~0U);
  return hn::And(hn::Shl(ones, small_integer(hn::Min(lo, last))),
                 hn::Shr(ones, small_integer(hn::Sub(last, hn::Max(hi, hn::Zero(d))))));
}

}  // namespace penumbra::gears::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
