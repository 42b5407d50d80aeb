// Triangles onto the mask of one view sample: per instruction set. Nothing that decides a bit uses a fused
// multiply-add or an approximate reciprocal, so that every instruction set gives the same masks.
#if defined(PENUMBRA_GEARS_CPU_MASKS) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_GEARS_CPU_MASKS
#undef PENUMBRA_GEARS_CPU_MASKS
#else
#define PENUMBRA_GEARS_CPU_MASKS
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
inline constexpr float far_away = 1e30F, least = 1e-20F;

// nx (i - px) + ny (j - py) + constant = 0, solved for column i of row j; a tiny nx keeps its sign.
HWY_INLINE Bound bound_of(Vector nx, Vector ny, Vector constant, Vector volume, const ViewPoint& p) {
  const Vector not_zero = hn::IfThenElse(hn::Lt(hn::Abs(nx), set(least)), hn::CopySign(set(least), nx), nx);
  const Vector inverse = hn::Div(set(-1), not_zero), slope = hn::Mul(ny, inverse);
  const Vector offset = hn::Add(hn::Sub(hn::Mul(constant, inverse), hn::Mul(slope, set(p.y))), set(p.x));
  return {slope, offset, sign_bit(hn::Xor(nx, volume))};
}

struct Columns {
  Vector from, to;
};
HWY_INLINE Columns on_row(const Bound& b, Vector row, const Columns& before) {
  const Vector at = hn::Add(hn::Mul(b.slope, row), b.offset);
  return {hn::IfThenElse(b.upper, before.from, hn::Max(before.from, at)),
          hn::IfThenElse(b.upper, hn::Min(before.to, at), before.to)};
}

// The bits of the columns [from, to], whole numbers, in a part of 32 columns; only where `some`.
HWY_INLINE hn::Vec<Words> bits_of_columns(const Columns& c, std::size_t part, Mask* some) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const Words du;
  const Vector base = set(static_cast<float>(32 * part)), last = set(31);
  const Vector lo = hn::Max(hn::Sub(c.from, base), hn::Zero(d)), hi = hn::Min(hn::Sub(c.to, base), last);
  *some = hn::And(*some, hn::Le(lo, hi));
  const auto skip_low = hn::BitCast(du, hn::ConvertTo(di, hn::Min(lo, last)));
  const auto skip_high = hn::BitCast(du, hn::ConvertTo(di, hn::Sub(last, hn::Max(hi, hn::Zero(d)))));
  const auto ones = hn::Set(du, ~0U);
  return hn::And(hn::Shl(ones, skip_low), hn::Shr(ones, skip_high));
}

// Triangles of few rows: lanes are triangles, one row of each at a time.
template <int edges>
HWY_INLINE void fill_short(const Bound* bounds, const Columns& columns, Vector first_row, Vector last_row,
                           Mask use, const LightView& light, uint32_t* mask) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const Words du;
  alignas(64) int32_t rows[block_size];
  alignas(64) uint32_t words[block_size];
  for (Vector row = first_row; !hn::AllFalse(d, use);) {
    Columns c = columns;
    for (int k = 0; k < edges; ++k) c = on_row(bounds[k], row, c);
    c = {hn::Ceil(c.from), hn::Floor(c.to)};
    const Mask covers = hn::And(use, hn::Le(c.from, c.to));
    if (!hn::AllFalse(d, covers)) {
      hn::Store(hn::ConvertTo(di, row), di, rows);
      for (std::size_t part = 0; part < light.parts; ++part) {
        Mask some = covers;
        hn::Store(bits_of_columns(c, part, &some), du, words);
        for (uint32_t bits = bits_of(some); bits; bits &= bits - 1) {
          const auto l = static_cast<std::size_t>(__builtin_ctz(bits));
          mask[part * most_rows + static_cast<std::size_t>(rows[l])] |= words[l];
        }
      }
    }
    row = hn::Add(row, set(1));
    use = hn::And(use, hn::Le(row, last_row));
  }
}

// The half-spaces of up to 16 triangles, for one triangle at a time: [0] from, [1] to.
struct alignas(64) Bounds {
  float slope[2][4][block_size], offset[2][4][block_size];
  float first_column[block_size], last_column[block_size];
  int32_t first_row[block_size], last_row[block_size];
};
HWY_INLINE void store_bound(const Bound& b, int edge, std::size_t at, Bounds& out) {
  const Floats d;
  hn::Store(hn::IfThenZeroElse(b.upper, b.slope), d, out.slope[0][edge] + at);
  hn::Store(hn::IfThenElse(b.upper, set(-far_away), b.offset), d, out.offset[0][edge] + at);
  hn::Store(hn::IfThenElseZero(b.upper, b.slope), d, out.slope[1][edge] + at);
  hn::Store(hn::IfThenElse(b.upper, b.offset, set(far_away)), d, out.offset[1][edge] + at);
}

// A triangle of many rows: lanes are rows.
template <int edges>
HWY_INLINE void fill_tall(const Bounds& e, std::size_t t, const LightView& light, uint32_t* mask) {
  const Floats d;
  const Words du;
  const auto lanes = static_cast<int32_t>(hn::Lanes(d));
  Vector slope[2][edges], offset[2][edges];
  for (int s = 0; s < 2; ++s)
    for (int k = 0; k < edges; ++k)
      slope[s][k] = set(e.slope[s][k][t]), offset[s][k] = set(e.offset[s][k][t]);
  const Vector c0 = set(e.first_column[t]), c1 = set(e.last_column[t]);
  const Vector r0 = set(static_cast<float>(e.first_row[t])), r1 = set(static_cast<float>(e.last_row[t]));
  for (int32_t r = e.first_row[t] / lanes * lanes; r <= e.last_row[t]; r += lanes) {
    const Vector row = hn::Iota(d, static_cast<float>(r));
    const auto at = [&](int s, int k) HWY_ATTR { return hn::Add(hn::Mul(slope[s][k], row), offset[s][k]); };
    Columns c{c0, c1};
    for (int k = 0; k < edges; ++k) c.from = hn::Max(c.from, at(0, k)), c.to = hn::Min(c.to, at(1, k));
    c = {hn::Ceil(c.from), hn::Floor(c.to)};
    const Mask rows = hn::And(hn::Ge(row, r0), hn::Le(row, r1));
    for (std::size_t part = 0; part < light.parts; ++part) {
      Mask some = rows;
      const auto bits = bits_of_columns(c, part, &some);
      uint32_t* to = mask + part * most_rows + static_cast<std::size_t>(r);
      hn::Store(hn::Or(hn::Load(du, to), hn::IfThenElseZero(hn::RebindMask(du, some), bits)), du, to);
    }
  }
}

inline constexpr float tall_rows = 5;

// `crossing`: triangles that may cross the light's plane.
template <bool crossing>
HWY_INLINE void rasterise_on_grid(const Block& block, const ViewPoint& p, const LightView& light,
                                  Scratch& scratch) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const Vector px = set(p.x), py = set(p.y), pz = set(p.z), zero = hn::Zero(d);
  const float rounding = 0.01F + 2e-6F * (std::abs(p.x) + std::abs(p.y));
  for (std::size_t i = 0; i < block_size; i += hn::Lanes(d)) {
    const auto corner = [&](Corner x) HWY_ATTR {
      // z is the height above P, towards the light.
      return Vector3{hn::Sub(hn::Load(d, block.v[x] + i), px), hn::Sub(hn::Load(d, block.v[x + 1] + i), py),
                     hn::Sub(pz, hn::Load(d, block.v[x + 2] + i))};
    };
    const Vector3 a = corner(ax), b = corner(bx), c = corner(cx);
    Mask use = hn::Gt(hn::Max(hn::Max(a.z, b.z), c.z), zero);
    if (hn::AllFalse(d, use)) continue;
    // The rectangle of light samples around the triangle's projection; all, where a corner is not above P.
    const Mask straddles = hn::Le(hn::Min(hn::Min(a.z, b.z), c.z), set(light.pad));
    const Vector s_a = hn::Div(pz, a.z), s_b = hn::Div(pz, b.z), s_c = hn::Div(pz, c.z);
    const auto range = [&](Vector u_a, Vector u_b, Vector u_c, Vector from, int count, Vector* first,
                           Vector* last) HWY_ATTR {
      const Vector v_a = hn::Mul(u_a, s_a), v_b = hn::Mul(u_b, s_b), v_c = hn::Mul(u_c, s_c);
      const Vector end = set(static_cast<float>(count - 1));
      const Vector lo = hn::Add(hn::Min(hn::Min(v_a, v_b), v_c), hn::Sub(from, set(rounding)));
      const Vector hi = hn::Add(hn::Max(hn::Max(v_a, v_b), v_c), hn::Add(from, set(rounding)));
      *first = hn::IfThenZeroElse(straddles, hn::Ceil(hn::Max(lo, zero)));
      *last = hn::IfThenElse(straddles, end, hn::Floor(hn::Min(hi, end)));
    };
    Vector c0, c1, r0, r1;
    range(a.x, b.x, c.x, px, light.columns, &c0, &c1);
    range(a.y, b.y, c.y, py, light.rows, &r0, &r1);
    use = hn::And(use, hn::And(hn::Le(c0, c1), hn::Le(r0, r1)));
    if (hn::AllFalse(d, use)) continue;

    constexpr int edges = crossing ? 4 : 3;
    const Vector3 ab = edge_normal(a, b), bc = edge_normal(b, c), ca = edge_normal(c, a);
    const Vector volume = dot3(ab, c);
    Bound bounds[edges] = {bound_of(ab.x, ab.y, hn::Mul(ab.z, pz), volume, p),
                           bound_of(bc.x, bc.y, hn::Mul(bc.z, pz), volume, p),
                           bound_of(ca.x, ca.y, hn::Mul(ca.z, pz), volume, p)};
    if constexpr (crossing) {
      const Vector3 n = edge_normal(minus(b, a), minus(c, a));
      bounds[3] = bound_of(n.x, n.y, hn::Sub(hn::Mul(n.z, pz), dot3(n, a)), volume, p);
    }
    scratch.counts.pairs += hn::CountTrue(d, use);
    const Mask tall = hn::And(use, hn::Ge(hn::Sub(r1, r0), set(tall_rows)));
    fill_short<edges>(bounds, {c0, c1}, r0, r1, hn::AndNot(tall, use), light, scratch.mask);
    if (hn::AllFalse(d, tall)) continue;
    Bounds e;
    for (int k = 0; k < edges; ++k) store_bound(bounds[k], k, i, e);
    hn::Store(c0, d, e.first_column + i), hn::Store(c1, d, e.last_column + i);
    hn::Store(hn::ConvertTo(di, r0), di, e.first_row + i),
        hn::Store(hn::ConvertTo(di, r1), di, e.last_row + i);
    for (uint32_t bits = bits_of(tall); bits; bits &= bits - 1)
      fill_tall<edges>(e, i + static_cast<std::size_t>(__builtin_ctz(bits)), light, scratch.mask);
  }
}

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

// No light sample is left to be seen.
template <bool grid>
HWY_INLINE bool all_blocked(const LightView& light, const uint32_t* mask) {
  if constexpr (!grid) {
    uint32_t all = ~0U;
    for (std::size_t w = 0; w < light.words(); ++w) all &= mask[w];
    return all == ~0U;
  } else {
    const Words du;
    auto all = hn::Set(du, ~0U);
    for (std::size_t part = 0; part < light.parts; ++part)
      for (std::size_t r = 0; r < static_cast<std::size_t>(light.rows); r += hn::Lanes(du))
        all = hn::And(all, hn::Load(du, mask + part * most_rows + r));
    return hn::AllTrue(du, hn::Eq(all, hn::Set(du, ~0U)));
  }
}

// Whether some light sample of a grid's rectangle is still to be seen.
HWY_INLINE bool is_open(const uint32_t* mask, int32_t c0, int32_t c1, int32_t r0, int32_t r1,
                        std::size_t parts) {
  const Words du;
  const hn::RebindToSigned<Words> di;
  const auto lanes = static_cast<int32_t>(hn::Lanes(du));
  for (std::size_t part = 0; part < parts; ++part) {
    const int32_t lo = std::max(c0 - 32 * static_cast<int32_t>(part), 0),
                  hi = std::min(c1 - 32 * static_cast<int32_t>(part), 31);
    if (lo > hi) continue;
    const auto columns = hn::Set(du, ~0U << lo & ~0U >> (31 - hi));
    for (int32_t r = r0 / lanes * lanes; r <= r1; r += lanes) {
      const auto row = hn::Iota(di, r);
      const auto rows = hn::And(hn::Gt(row, hn::Set(di, r0 - 1)), hn::Lt(row, hn::Set(di, r1 + 1)));
      const auto open =
          hn::AndNot(hn::Load(du, mask + part * most_rows + static_cast<std::size_t>(r)), columns);
      if (!hn::AllFalse(du, hn::And(hn::RebindMask(du, rows), hn::Ne(open, hn::Zero(du))))) return true;
    }
  }
  return false;
}

}  // namespace penumbra::gears::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
