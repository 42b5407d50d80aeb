// The edges that part the light's samples, seen from one view sample: per instruction set. What decides a bit
// here is computed without fused multiply-adds and without approximate reciprocals, lane by lane, so that
// every instruction set and every vector length gives the same.
#if defined(PENUMBRA_DEPTH_COMPLEXITY_CROSSINGS) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_DEPTH_COMPLEXITY_CROSSINGS
#undef PENUMBRA_DEPTH_COMPLEXITY_CROSSINGS
#else
#define PENUMBRA_DEPTH_COMPLEXITY_CROSSINGS
#endif
#include "techniques/depth_complexity_sampling/cull-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::depth_complexity::HWY_NAMESPACE {

inline constexpr float beyond = 1e30F;  // a projection that is farther than any sample, in its direction

// Where the samples lie, seen from the view sample: a grid's from (0, 0) on; a set's strictly inside these
// bounds.
struct View {
  ViewPoint p;
  float x_lo, x_hi, y_lo, y_hi;
  float tiny;  // vertices nearer than this to the plane through P, across z, count as behind it
};

// The one expression that says on which side of a face the view sample is. Zero counts as +, for all its
// edges.
HWY_INLINE Vector side_of(Vector nx, Vector ny, Vector nz, Vector offset_of, Vector px, Vector py,
                          Vector pz) {
  return hn::Sub(hn::Add(hn::Add(hn::Mul(nx, px), hn::Mul(ny, py)), hn::Mul(nz, pz)), offset_of);
}

// One end of the edges, projected. Everything here depends on the vertex and the view sample alone, so that
// all edges of a vertex agree on it.
struct End {
  Vector x, y, h;  // relative to P; h: distance before it, along -z
  Mask before;
  Vector at_x, at_y;  // on the plane z = 0
};

template <class Load>
HWY_INLINE End project(const Load& load, Field fx, Field fy, Field fz, Vector px, Vector py, Vector pz,
                       Vector tiny) {
  End e;
  e.x = hn::Sub(load(fx), px), e.y = hn::Sub(load(fy), py), e.h = hn::Sub(pz, load(fz));
  e.before = hn::Gt(e.h, tiny);
  const Vector scale = hn::Div(pz, e.h);
  e.at_x = hn::Add(px, hn::Mul(e.x, scale));
  e.at_y = hn::Add(py, hn::Mul(e.y, scale));
  return e;
}

struct Line {
  Vector x0, y0, slope;
};

// The edge's line from the plane through it and P, for ends behind P or far away: anchored near the samples.
HWY_INLINE Line line_of_plane(const End& a, const End& b, const View& view) {
  const auto cross_of = [](Vector p, Vector q, Vector r, Vector s)
                            HWY_ATTR { return hn::Sub(hn::Mul(p, s), hn::Mul(q, r)); };
  const auto not_zero = [&](Vector v) HWY_ATTR {
    return hn::IfThenElse(hn::Lt(hn::Abs(v), set(1e-30F)), set(1e-30F), v);
  };
  const Vector nx = not_zero(cross_of(a.y, a.h, b.y, b.h)), ny = not_zero(cross_of(a.h, a.x, b.h, b.x));
  const Vector nz = cross_of(a.x, a.y, b.x, b.y);
  // nx (x - Px) + ny (y - Py) + nz Pz = 0
  const Vector constant = hn::Mul(nz, set(view.p.z));
  const Vector mid_x = set((view.x_lo + view.x_hi) * 0.5F), mid_y = set((view.y_lo + view.y_hi) * 0.5F);
  const Vector at_mid_x =
      hn::Sub(set(view.p.y), hn::Div(hn::Add(hn::Mul(nx, hn::Sub(mid_x, set(view.p.x))), constant), ny));
  const Vector at_mid_y =
      hn::Sub(set(view.p.x), hn::Div(hn::Add(hn::Mul(ny, hn::Sub(mid_y, set(view.p.y))), constant), nx));
  const Mask steep = hn::Gt(hn::Abs(nx), hn::Abs(ny));
  return {hn::IfThenElse(steep, at_mid_y, mid_x), hn::IfThenElse(steep, mid_y, at_mid_x),
          hn::Neg(hn::Div(nx, ny))};
}

// Finds the crossings and events of one view sample among a list of edges. Which edges are left out (below
// the samples, or with both ends above them) adds the same to all samples: an edge from a vertex above the
// first row to one that is not leaves an event at that vertex's column instead, as the edges above telescope.
template <bool grid>
HWY_INLINE void find_crossings(const EdgeList& edges, const View& view, Crossings& out) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const std::size_t lanes = hn::Lanes(d);
  const Vector px = set(view.p.x), py = set(view.p.y), pz = set(view.p.z), zero = hn::Zero(d),
               tiny = set(view.tiny);
  const Vector first_row = set(view.y_lo), last_row = set(view.y_hi), columns = set(view.x_hi + 1);
  std::size_t count = 0, events = 0;
  for (std::size_t o = 0; o < edges.count; o += lanes) {
    const auto load = [&](Field f) HWY_ATTR { return hn::LoadU(d, edges.v[f].data() + o); };
    const Vector s1 = side_of(load(n1x), load(n1y), load(n1z), load(d1), px, py, pz);
    const Vector s2 = side_of(load(n2x), load(n2y), load(n2z), load(d2), px, py, pz);
    Mask use = sign_bit(hn::Xor(hn::Xor(s1, s2), load(flip)));
    if (o + lanes > edges.count) use = hn::And(use, hn::FirstN(d, edges.count - o));
    if (hn::AllFalse(d, use)) continue;

    End a = project(load, ax, ay, az, px, py, pz, tiny), b = project(load, bx, by, bz, px, py, pz, tiny);
    const Mask both = hn::And(a.before, b.before);
    use = hn::And(use, hn::Or(a.before, b.before));
    const Mask behind = hn::AndNot(both, use);
    if (HWY_UNLIKELY(!hn::AllFalse(d, behind))) {
      // Cut off at the plane through P, an edge goes on to infinity. What runs along there, from one cut edge
      // to the next, adds the same to all samples, wherever it passes.
      const auto far_end = [&](const End& from, const End& to) HWY_ATTR {
        const Vector dx = hn::Sub(hn::Mul(to.x, from.h), hn::Mul(from.x, to.h));
        return hn::IfThenElse(hn::Gt(dx, zero), set(beyond), set(-beyond));
      };
      const Vector x_a = far_end(b, a), x_b = far_end(a, b);
      a.at_x = hn::IfThenElse(a.before, a.at_x, x_a), b.at_x = hn::IfThenElse(b.before, b.at_x, x_b);
    }
    const Mask above_a = hn::And(a.before, hn::Lt(a.at_y, first_row));
    const Mask above_b = hn::And(b.before, hn::Lt(b.at_y, first_row));
    const Mask below = hn::And(both, hn::Gt(hn::Min(a.at_y, b.at_y), last_row));
    use = hn::AndNot(hn::Or(hn::And(above_a, above_b), below), use);
    // Grid: the first column behind the vertex. Clamped, as what lies beside the light makes no difference.
    const auto column = [&](Vector x) HWY_ATTR {
      return grid ? hn::Min(hn::Max(hn::Ceil(x), zero), columns)
                  : hn::Min(hn::Max(x, set(view.x_lo)), set(view.x_hi));
    };
    const Vector c_a = column(a.at_x), c_b = column(b.at_x);
    const Mask crosses = hn::And(use, hn::Ne(c_a, c_b));
    const Mask event = hn::And(use, hn::Or(above_a, above_b));
    if (hn::AllFalse(d, hn::Or(crosses, event))) continue;

    // Times the side of the first face that P is on.
    const auto magnitude = hn::ConvertTo(d, hn::BitCast(di, load(weight)));
    const Vector w = hn::IfThenElse(sign_bit(s1), hn::Neg(magnitude), magnitude);
    if (!hn::AllFalse(d, event)) {
      const Mask e_a = hn::And(event, above_a), e_b = hn::And(event, above_b);
      const Packing of_a(e_a), of_b(e_b);
      of_a.store(c_a, out.v[event_x].data() + events);
      of_a.store(hn::Neg(w), out.v[event_weight].data() + events);
      events += of_a.count();
      of_b.store(c_b, out.v[event_x].data() + events);
      of_b.store(w, out.v[event_weight].data() + events);
      events += of_b.count();
    }
    if (hn::AllFalse(d, crosses)) continue;

    const Vector slope = hn::Div(hn::Sub(b.at_y, a.at_y), hn::Sub(b.at_x, a.at_x));
    Line line{a.at_x, a.at_y, slope};
    Vector lo = hn::Min(a.at_y, b.at_y), hi = hn::Max(a.at_y, b.at_y);
    const Vector farthest =
        hn::Max(hn::Max(hn::Abs(a.at_x), hn::Abs(b.at_x)), hn::Max(hn::Abs(a.at_y), hn::Abs(b.at_y)));
    const Mask by_plane = hn::And(crosses, hn::Or(behind, hn::Gt(farthest, set(2048.0F))));
    if (HWY_UNLIKELY(!hn::AllFalse(d, by_plane))) {
      const Line l = line_of_plane(a, b, view);
      line.x0 = hn::IfThenElse(by_plane, l.x0, line.x0);
      line.y0 = hn::IfThenElse(by_plane, l.y0, line.y0);
      line.slope = hn::IfThenElse(by_plane, l.slope, line.slope);
      lo = hn::IfThenElse(behind, set(-beyond), lo), hi = hn::IfThenElse(behind, set(beyond), hi);
    }
    const Packing packing(crosses);
    const auto keep = [&](CrossingField f, Vector v) HWY_ATTR { packing.store(v, out.v[f].data() + count); };
    keep(cross_x0, line.x0), keep(cross_y0, line.y0);
    keep(cross_slope, hn::Min(hn::Max(line.slope, set(-beyond)), set(beyond)));
    keep(cross_lo, hn::Max(lo, first_row));
    keep(cross_hi, hn::Min(hi, hn::Add(last_row, set(1.0F))));
    keep(cross_first, hn::Min(c_a, c_b)), keep(cross_last, hn::Max(c_a, c_b));
    keep(cross_weight, hn::IfThenElse(hn::Lt(c_b, c_a), hn::Neg(w), w));
    count += packing.count();
  }
  out.count = count, out.events = events;
}

}  // namespace penumbra::depth_complexity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
