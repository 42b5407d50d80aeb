// Triangles onto the mask of one view sample, for a set of light samples that is no grid: per instruction
// set. As cpu_projection-inl.h, the same on each of them.
#if defined(PENUMBRA_GEARS_CPU_SETS) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_GEARS_CPU_SETS
#undef PENUMBRA_GEARS_CPU_SETS
#else
#define PENUMBRA_GEARS_CPU_SETS
#endif
#include "techniques/gears/cpu_projection-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::gears::cpu::HWY_NAMESPACE {

// Light samples of a set relative to P'; directions stay.
HWY_INLINE void look_at_set(const LightView& light, const ViewPoint& p, Scratch& scratch) {
  const Floats d;
  const std::size_t n = light.x.size();
  if (scratch.to_x.size() < n) scratch.to_x.resize(n), scratch.to_y.resize(n), scratch.to_z.resize(n);
  const float scale = light.infinite ? 0.0F : 1.0F;
  const Vector px = set(p.x * scale), py = set(p.y * scale), pz = set(p.z * scale);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::StoreU(hn::Sub(hn::LoadU(d, light.x.data() + i), px), d, scratch.to_x.data() + i);
    hn::StoreU(hn::Sub(hn::LoadU(d, light.y.data() + i), py), d, scratch.to_y.data() + i);
    hn::StoreU(hn::Sub(hn::LoadU(d, light.z.data() + i), pz), d, scratch.to_z.data() + i);
  }
}

// What a triangle hides is on the positive side of its edges' planes through P and beyond its own.
struct HalfSpaces {
  float v[12][block_size], volume[block_size];
};

HWY_INLINE void fill_set(const HalfSpaces& h, std::size_t t, const LightView& light, Scratch& scratch) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  Vector n[12];
  for (int k = 0; k < 12; ++k) n[k] = set(h.v[k][t]);
  const Vector volume = set(h.volume[t]), zero = hn::Zero(d);
  for (std::size_t w = 0; w < light.words(); ++w) {
    uint32_t hidden = 0;
    if (scratch.mask[w] == ~0U) continue;
    for (std::size_t i = 0; i < 32; i += lanes) {
      const Vector3 to{hn::LoadU(d, scratch.to_x.data() + 32 * w + i),
                       hn::LoadU(d, scratch.to_y.data() + 32 * w + i),
                       hn::LoadU(d, scratch.to_z.data() + 32 * w + i)};
      const auto side = [&](int k) HWY_ATTR { return dot3(Vector3{n[k], n[k + 1], n[k + 2]}, to); };
      Mask inside = hn::And(hn::Ge(side(0), zero), hn::And(hn::Ge(side(3), zero), hn::Ge(side(6), zero)));
      inside = hn::And(inside, light.infinite ? hn::Gt(volume, zero) : hn::Gt(side(9), volume));
      hidden |= bits_of(inside) << i;
    }
    scratch.mask[w] |= hidden;
  }
}

HWY_INLINE void rasterise_on_set(const Block& block, const ViewPoint& p, const LightView& light,
                                 const Hull& hull, Scratch& scratch) {
  const Floats d;
  const Vector px = set(p.x), py = set(p.y), pz = set(p.z);
  for (std::size_t i = 0; i < block_size; i += hn::Lanes(d)) {
    const auto load = [&](int x) HWY_ATTR { return hn::Load(d, block.v[x] + i); };
    const Mask use = hull.meets(box_of_triangles(load));
    if (hn::AllFalse(d, use)) continue;
    const auto corner = [&](Corner x) HWY_ATTR {
      return Vector3{hn::Sub(load(x), px), hn::Sub(load(x + 1), py), hn::Sub(load(x + 2), pz)};
    };
    const Vector3 a = corner(ax), b = corner(bx), c = corner(cx);
    const Vector3 normals[4] = {edge_normal(a, b), edge_normal(b, c), edge_normal(c, a),
                                edge_normal(minus(b, a), minus(c, a))};
    const Vector volume = dot3(normals[0], c);
    const Vector sign = hn::And(volume, set(-0.0F));
    HalfSpaces h;
    for (int k = 0; k < 4; ++k) {
      hn::StoreU(hn::Xor(normals[k].x, sign), d, h.v[3 * k] + i);
      hn::StoreU(hn::Xor(normals[k].y, sign), d, h.v[3 * k + 1] + i);
      hn::StoreU(hn::Xor(normals[k].z, sign), d, h.v[3 * k + 2] + i);
    }
    hn::StoreU(hn::Abs(volume), d, h.volume + i);
    for (uint32_t bits = bits_of(use); bits; bits &= bits - 1) {
      ++scratch.counts.pairs;
      fill_set(h, i + static_cast<std::size_t>(__builtin_ctz(bits)), light, scratch);
    }
  }
}

class SetMask {
 public:
  static constexpr bool grid = false;
  HWY_INLINE SetMask(const LightView& light, const ViewPoint& p, Scratch& scratch)
      : light_(light), p_(p), scratch_(scratch) {
    look_at_set(light, p, scratch);
  }
  template <bool crossing>
  HWY_INLINE void add(const Block& block, const Hull& hull) {
    rasterise_on_set(block, p_, light_, hull, scratch_);
  }
  // No light sample is left to be seen.
  HWY_INLINE bool all_blocked() const {
    uint32_t all = ~0U;
    for (std::size_t w = 0; w < light_.words(); ++w) all &= scratch_.mask[w];
    return all == ~0U;
  }
  HWY_INLINE void finish() const {}

 private:
  const LightView& light_;
  const ViewPoint& p_;
  Scratch& scratch_;
};

}  // namespace penumbra::gears::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
