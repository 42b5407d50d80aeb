// Which boxes may hide a light sample from a group of view samples, or from one: per instruction set. All of
// it is conservative.
#if defined(PENUMBRA_GEARS_CPU_BOXES) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_GEARS_CPU_BOXES
#undef PENUMBRA_GEARS_CPU_BOXES
#else
#define PENUMBRA_GEARS_CPU_BOXES
#endif
#include <algorithm>
#include <cmath>

#include "techniques/common/lanes-inl.h"
#include "techniques/gears/cpu_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::gears::cpu::HWY_NAMESPACE {
using namespace lanes::HWY_NAMESPACE;

static_assert(most_lanes == block_size);

struct PointBox {
  float lo[3], hi[3];
};
HWY_INLINE PointBox box_of(const ViewPoint* p, std::size_t count) {
  PointBox b{{p->x, p->y, p->z}, {p->x, p->y, p->z}};
  for (std::size_t i = 1; i < count; ++i) {
    const float v[3] = {p[i].x, p[i].y, p[i].z};
    for (int k = 0; k < 3; ++k) b.lo[k] = std::min(b.lo[k], v[k]), b.hi[k] = std::max(b.hi[k], v[k]);
  }
  return b;
}

struct BoxVectors {
  Vector v[box_fields];
};
template <class Load>
HWY_INLINE BoxVectors box_of_triangles(const Load& load) {
  BoxVectors b;
  for (int k = 0; k < 3; ++k) {
    b.v[lo_x + k] = hn::Min(hn::Min(load(ax + k), load(bx + k)), load(cx + k));
    b.v[hi_x + k] = hn::Max(hn::Max(load(ax + k), load(bx + k)), load(cx + k));
  }
  return b;
}

// The rectangles of a grid's light samples that boxes can hide from any view sample of a group.
struct Rectangles {
  Vector c0, c1, r0, r1;
  Mask some;
};

// A point q hides from p the point q s + p (1 - s) of the light's plane, s = pz / (pz - qz) >= 1 for q before
// that plane; per axis it is extreme at the ends of s. What reaches down to the view samples' own height may
// hide anything on its side.
HWY_INLINE Rectangles rectangles_of(const BoxVectors& b, const PointBox& p, const LightView& light) {
  const Floats d;
  const Vector zero = hn::Zero(d), p_lo = set(p.lo[2]), p_hi = set(p.hi[2]), pad = set(light.pad);
  const Vector z0 = hn::Max(b.v[lo_z], zero);
  Rectangles out;
  out.some = hn::Lt(z0, p_hi);
  const Vector s0 = hn::Div(p_hi, hn::Add(hn::Sub(p_hi, z0), pad));
  const Vector rest = hn::Sub(hn::Sub(p_lo, b.v[hi_z]), pad);
  const Vector s1 = hn::IfThenElse(hn::Gt(rest, pad), hn::Div(p_lo, rest), set(1e30F));
  const auto range = [&](int axis, int count, Vector* first, Vector* last) HWY_ATTR {
    const float most = std::max(std::abs(p.lo[axis]), std::abs(p.hi[axis]));
    const Vector rounding = set(0.01F + 2e-6F * most), twice = set(2 * light.pad);
    const Vector from = set(p.hi[axis]), to = set(p.lo[axis]);
    const Vector below = hn::Sub(hn::Sub(b.v[lo_x + axis], from), twice),
                 above = hn::Add(hn::Sub(b.v[hi_x + axis], to), twice);
    const Vector lo = hn::Add(hn::Mul(below, hn::IfThenElse(hn::Ge(below, zero), s0, s1)), from),
                 hi = hn::Add(hn::Mul(above, hn::IfThenElse(hn::Ge(above, zero), s1, s0)), to);
    *first = hn::Ceil(hn::Max(hn::Sub(lo, rounding), zero));
    *last = hn::Floor(hn::Min(hn::Add(hi, rounding), set(static_cast<float>(count - 1))));
    out.some = hn::And(out.some, hn::Le(*first, *last));
  };
  range(0, light.columns, &out.c0, &out.c1);
  range(1, light.rows, &out.r0, &out.r1);
  return out;
}

// For a set of light samples: the hull of a group's box and the samples' box is the union of the boxes
// between them, box(t) = group + t (light - group) for t in [0, 1] (directions: any t); a box that meets it
// meets box(t) in all axes for one t: six linear conditions on t.
class Hull {
 public:
  HWY_INLINE Hull(const PointBox& p, const LightView& light) : p_(p), end_(light.infinite ? 1e30F : 1.0F) {
    pad_ = light.pad;
    const float lo[3] = {light.lo.x, light.lo.y, light.lo.z}, hi[3] = {light.hi.x, light.hi.y, light.hi.z};
    for (int k = 0; k < 3; ++k) {
      const float to_lo = light.infinite ? lo[k] : lo[k] - p.lo[k],
                  to_hi = light.infinite ? hi[k] : hi[k] - p.hi[k];
      up_lo_[k] = to_lo >= -1e-30F, up_hi_[k] = to_hi >= -1e-30F;
      per_lo_[k] = 1 / (std::abs(to_lo) < 1e-30F ? 1e-30F : to_lo);
      per_hi_[k] = 1 / (std::abs(to_hi) < 1e-30F ? 1e-30F : to_hi);
    }
  }
  HWY_INLINE Mask meets(const BoxVectors& b) const {
    const Floats d;
    Vector t0 = hn::Zero(d), t1 = set(end_);
    for (int k = 0; k < 3; ++k) {
      const Vector need_hi = hn::Sub(b.v[lo_x + k], set(p_.hi[k] + pad_)),
                   need_lo = hn::Sub(b.v[hi_x + k], set(p_.lo[k] - pad_));
      const Vector r_hi = hn::Mul(need_hi, set(per_hi_[k])), r_lo = hn::Mul(need_lo, set(per_lo_[k]));
      if (up_hi_[k])
        t0 = hn::Max(t0, r_hi);
      else
        t1 = hn::Min(t1, r_hi);
      if (up_lo_[k])
        t1 = hn::Min(t1, r_lo);
      else
        t0 = hn::Max(t0, r_lo);
    }
    return hn::Le(t0, hn::Add(t1, hn::Mul(set(1e-5F), hn::Add(set(1), hn::Abs(t1)))));
  }

 private:
  PointBox p_;
  float end_, pad_, per_lo_[3], per_hi_[3];
  bool up_lo_[3], up_hi_[3];
};

}  // namespace penumbra::gears::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
