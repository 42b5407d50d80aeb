// Which nodes, blocks and edges can matter to a group of view samples: per instruction set. All of it is
// conservative (fused multiply-adds may round as they like): what is kept without need changes no mask.
#if defined(PENUMBRA_DEPTH_COMPLEXITY_CULL) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_DEPTH_COMPLEXITY_CULL
#undef PENUMBRA_DEPTH_COMPLEXITY_CULL
#else
#define PENUMBRA_DEPTH_COMPLEXITY_CULL
#endif
#include <algorithm>

#include "techniques/depth_complexity_sampling/packing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::depth_complexity::HWY_NAMESPACE {

// The bounds of some view samples, and where seen from them the light's samples lie on the plane z = 0.
struct PointBox {
  float lo[3], hi[3], center[3], half[3];
  float window_lo[2], window_hi[2];
};

HWY_INLINE PointBox box_of(const ViewPoint* p, std::size_t count, const LightSpace& light) {
  PointBox b{{p->x, p->y, p->z}, {p->x, p->y, p->z}, {}, {}, {}, {}};
  for (std::size_t i = 1; i < count; ++i) {
    const float v[3] = {p[i].x, p[i].y, p[i].z};
    for (int k = 0; k < 3; ++k) b.lo[k] = std::min(b.lo[k], v[k]), b.hi[k] = std::max(b.hi[k], v[k]);
  }
  const float rounding = light.magnitude * 0x1p-22F;
  for (int k = 0; k < 3; ++k) {
    b.center[k] = (b.lo[k] + b.hi[k]) * 0.5F;
    b.half[k] = (b.hi[k] - b.lo[k]) * 0.5F + rounding;
  }
  // A sample below z = 0 is seen between where it lies and where the view sample does.
  const float t = light.lo.z < 0 ? light.lo.z / (light.lo.z - b.lo[2]) : 0.0F;
  for (int k = 0; k < 2; ++k) {
    b.window_lo[k] = light.lo[k] + std::min(0.0F, t * (b.lo[k] - light.lo[k]));
    b.window_hi[k] = light.hi[k] + std::max(0.0F, t * (b.hi[k] - light.hi[k]));
  }
  return b;
}

// Boxes that meet the convex hull of the light and the view samples. t: how far along a segment from the
// light to a view sample the box can lie.
template <class Load>
HWY_INLINE Mask in_shaft(const Load& load, const PointBox& b, const LightSpace& light) {
  const Vector one = set(1), rounding = set(light.magnitude * 0x1p-19F);
  const Vector t_lo = hn::Min(hn::Mul(load(lo_z), set(1 / b.hi[2])), one);
  const Vector t_hi =
      hn::Min(hn::Mul(hn::Sub(load(hi_z), set(light.lo.z)), set(1 / (b.lo[2] - light.lo.z))), one);
  const auto along = [&](Vector lo, Vector hi, float light_lo, float light_hi, float from,
                         float to) HWY_ATTR {
    const Vector p = set(from - light_lo), q = set(to - light_hi);
    const Vector least = hn::Add(set(light_lo), hn::Min(hn::Mul(t_lo, p), hn::Mul(t_hi, p)));
    const Vector most = hn::Add(set(light_hi), hn::Max(hn::Mul(t_lo, q), hn::Mul(t_hi, q)));
    return hn::And(hn::Ge(hn::Add(hi, rounding), least), hn::Le(hn::Sub(lo, rounding), most));
  };
  return hn::And(hn::Lt(load(lo_z), set(b.hi[2])),
                 hn::And(along(load(lo_x), load(hi_x), light.lo.x, light.hi.x, b.lo[0], b.hi[0]),
                         along(load(lo_y), load(hi_y), light.lo.y, light.hi.y, b.lo[1], b.hi[1])));
}

// Nodes in the shaft that can hold a silhouette: not all faces see all view samples from the cancelling side.
template <class Load>
HWY_INLINE Mask can_matter(const Load& load, const PointBox& b, const LightSpace& light) {
  const Mask inside = in_shaft(load, b, light);
  if (hn::AllFalse(Floats(), inside)) return inside;
  const Vector half = set(0.5F);
  const auto from_center = [&](NodeField lo, NodeField hi, int k) HWY_ATTR {
    return hn::NegMulAdd(hn::Add(load(lo), load(hi)), half, set(b.center[k]));
  };
  const Vector x = from_center(lo_x, hi_x, 0), y = from_center(lo_y, hi_y, 1), z = from_center(lo_z, hi_z, 2);
  const Vector nx = load(normal_x), ny = load(normal_y), nz = load(normal_z);
  const Vector hx = set(b.half[0]), hy = set(b.half[1]), hz = set(b.half[2]);
  const Vector side = hn::MulAdd(nx, x, hn::MulAdd(ny, y, hn::MulSub(nz, z, load(offset))));
  Vector reach = load(offset_spread);
  reach = hn::MulAdd(load(spread_x), hn::Add(hn::Abs(x), hx), reach);
  reach = hn::MulAdd(load(spread_y), hn::Add(hn::Abs(y), hy), reach);
  reach = hn::MulAdd(load(spread_z), hn::Add(hn::Abs(z), hz), reach);
  reach = hn::MulAdd(hn::Abs(nx), hx, reach);
  reach = hn::MulAdd(hn::Abs(ny), hy, reach);
  reach = hn::MulAdd(hn::Abs(nz), hz, reach);
  return hn::And(inside, hn::Le(hn::Abs(side), reach));
}

// Whether an edge, as an endless line, hides no light sample from any of the view samples: the determinant of
// (A - P, B - P, L - P) has one sign at all corners of the light.
template <class Load>
HWY_NOINLINE Mask line_misses_light(const Load& load, const PointBox& b, const LightSpace& light) {
  const auto relative = [&](Field f, int k) HWY_ATTR { return hn::Sub(load(f), set(b.center[k])); };
  const Vector a[3] = {relative(ax, 0), relative(ay, 1), relative(az, 2)};
  const Vector e[3] = {relative(bx, 0), relative(by, 1), relative(bz, 2)};
  const auto cross_product = [](const Vector* p, const Vector* q, Vector* out) HWY_ATTR {
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      out[k] = hn::MulSub(p[i], q[j], hn::Mul(p[j], q[i]));
    }
  };
  Vector n[3];
  cross_product(a, e, n);
  Vector least = set(1e30F), most = set(-1e30F), reach = hn::Zero(Floats());
  for (int corner = 0; corner < 8; ++corner) {
    const Vector l[3] = {set((corner & 1 ? light.hi.x : light.lo.x) - b.center[0]),
                         set((corner & 2 ? light.hi.y : light.lo.y) - b.center[1]),
                         set((corner & 4 ? light.hi.z : light.lo.z) - b.center[2])};
    Vector u[3], w[3], volume = hn::Zero(Floats()), spread = hn::Zero(Floats()), size = hn::Zero(Floats());
    cross_product(e, l, u);
    cross_product(l, a, w);
    for (int k = 0; k < 3; ++k) {
      volume = hn::MulAdd(n[k], l[k], volume);
      size = hn::MulAdd(hn::Abs(n[k]), hn::Abs(l[k]), size);
      // The determinant's gradient in P.
      const Vector gradient = hn::Add(n[k], hn::Add(u[k], w[k]));
      spread = hn::MulAdd(hn::Abs(gradient), set(b.half[k]), spread);
    }
    least = hn::Min(least, volume), most = hn::Max(most, volume);
    reach = hn::Max(reach, hn::MulAdd(size, set(2e-5F), spread));
  }
  return hn::Or(hn::Gt(least, reach), hn::Lt(most, hn::Neg(reach)));
}

// Edges that can be silhouettes for some of the view samples and project to where light samples lie, or
// beside their rows. `coarse`: for a middle group, where long edges are worth the test above.
template <class Load>
HWY_INLINE Mask edges_that_matter(const Load& load, const PointBox& b, const LightSpace& light, bool coarse) {
  const Floats d;
  const Vector rounding = set(light.magnitude * 0x1p-18F);
  const auto side = [&](Field nx, Field ny, Field nz, Field offset_of) HWY_ATTR {
    return hn::MulAdd(
        load(nx), set(b.center[0]),
        hn::MulAdd(load(ny), set(b.center[1]), hn::MulSub(load(nz), set(b.center[2]), load(offset_of))));
  };
  const auto reach = [&](Field nx, Field ny, Field nz) HWY_ATTR {
    return hn::MulAdd(hn::Abs(load(nx)), set(b.half[0]),
                      hn::MulAdd(hn::Abs(load(ny)), set(b.half[1]),
                                 hn::MulAdd(hn::Abs(load(nz)), set(b.half[2]), rounding)));
  };
  const Vector s1 = side(n1x, n1y, n1z, d1), s2 = side(n2x, n2y, n2z, d2);
  const Vector differ = hn::Xor(hn::Xor(s1, s2), load(flip));
  Mask keep =
      hn::Or(hn::Or(hn::Le(hn::Abs(s1), reach(n1x, n1y, n1z)), hn::Le(hn::Abs(s2), reach(n2x, n2y, n2z))),
             hn::Lt(hn::Or(hn::And(differ, set(-0.0F)), set(1.0F)), hn::Zero(d)));
  const Vector a_z = load(az), b_z = load(bz);
  const Vector far_z = hn::Max(a_z, b_z), gap = hn::Sub(set(b.lo[2]), far_z);
  const Mask before =
      hn::Gt(gap, set(light.magnitude * 0x1p-14F));  // of all view samples, by a clear distance
  keep = hn::And(keep, hn::Lt(hn::Min(a_z, b_z), set(b.hi[2])));
  if (hn::AllFalse(d, keep)) return keep;
  if (coarse) {
    const auto extent = [&](Field p, Field q) HWY_ATTR { return hn::Abs(hn::Sub(load(p), load(q))); };
    const Vector largest = hn::Max(extent(ax, bx), hn::Max(extent(ay, by), extent(az, bz)));
    const Mask is_long = hn::AndNot(
        before, hn::And(keep, hn::Gt(largest, set(16 * std::max({b.half[0], b.half[1], b.half[2]})))));
    if (!hn::AllFalse(d, is_long))
      keep = hn::AndNot(hn::And(is_long, line_misses_light(load, b, light)), keep);
  }
  if (hn::AllFalse(d, hn::And(keep, before))) return keep;

  // Projected from the box's centre, and how far that moves within the box: dX/dPx = -z / h, dX/dPz = (Ax -
  // Px) times -z / h^2, with h the distance to the plane through P.
  const Vector center_z = set(b.center[2]), inverse = hn::Div(set(1.0F), gap);
  const Vector q = hn::Mul(far_z, inverse), q_z = hn::Mul(hn::Mul(q, inverse), set(b.half[2]));
  const Vector scale_a = hn::Div(center_z, hn::Sub(center_z, a_z)),
               scale_b = hn::Div(center_z, hn::Sub(center_z, b_z));
  const auto project = [&](Field fa, Field fb, int k, Vector& lo, Vector& hi) HWY_ATTR {
    const Vector p = set(b.center[k]), half = set(b.half[k]);
    const Vector da = hn::Sub(load(fa), p), db = hn::Sub(load(fb), p);
    const Vector ma = hn::Mul(da, scale_a), mb = hn::Mul(db, scale_b);
    Vector r = hn::MulAdd(q, half, hn::Mul(q_z, hn::Add(hn::Max(hn::Abs(da), hn::Abs(db)), half)));
    r = hn::MulAdd(hn::Max(hn::Abs(ma), hn::Abs(mb)), set(1e-5F), r);
    r = hn::MulAdd(r, set(1.0001F), set(light.magnitude * 0x1p-19F));
    lo = hn::Sub(hn::Add(p, hn::Min(ma, mb)), r), hi = hn::Add(hn::Add(p, hn::Max(ma, mb)), r);
  };
  Vector x_lo, x_hi, y_lo, y_hi;
  project(ax, bx, 0, x_lo, x_hi);
  project(ay, by, 1, y_lo, y_hi);
  Mask touches = hn::And(hn::And(hn::Ge(x_hi, set(b.window_lo[0])), hn::Le(x_lo, set(b.window_hi[0]))),
                         hn::And(hn::Ge(y_hi, set(b.window_lo[1])), hn::Le(y_lo, set(b.window_hi[1]))));
  // Between two columns of a grid only an edge that begins or ends above it matters.
  if (light.grid)
    touches = hn::And(touches, hn::Or(hn::Ne(hn::Ceil(x_lo), hn::Ceil(x_hi)), hn::Le(y_lo, set(0.0F))));
  return hn::And(keep, hn::Or(touches, hn::Not(before)));
}

}  // namespace penumbra::depth_complexity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
