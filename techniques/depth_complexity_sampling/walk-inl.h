// From a group of view samples down to each one's candidates: per instruction set.
#if defined(PENUMBRA_DEPTH_COMPLEXITY_WALK) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_DEPTH_COMPLEXITY_WALK
#undef PENUMBRA_DEPTH_COMPLEXITY_WALK
#else
#define PENUMBRA_DEPTH_COMPLEXITY_WALK
#endif
#include "techniques/depth_complexity_sampling/counters-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::depth_complexity::HWY_NAMESPACE {

// Which of 16 nodes from `first` on, whose fields lie in `v`, can matter.
HWY_INLINE uint32_t nodes_that_matter(const std::vector<float>* v, std::size_t first, const PointBox& box,
                                      const LightSpace& light) {
  const Floats d;
  uint32_t bits = 0;
  for (std::size_t i = 0; i < block_edges; i += hn::Lanes(d))
    bits |= bits_of(can_matter([&](NodeField f) HWY_ATTR { return hn::LoadU(d, v[f].data() + first + i); },
                               box, light))
            << i;
  return bits;
}

// Blocks that can matter to the group, and their nodes' fields side by side.
HWY_INLINE void find_blocks(const Silhouettes& s, const PointBox& box, const LightSpace& light,
                            Scratch& scratch) {
  const std::size_t top = s.level_count() - 1;
  std::vector<uint32_t>&stack = scratch.stack, &found = scratch.found;
  found.clear(), stack.clear();
  constexpr uint32_t level_shift = 28;  // a stack entry: level, and the first of 16 nodes over 16
  stack.push_back(static_cast<uint32_t>(top << level_shift));
  while (!stack.empty()) {
    const uint32_t entry = stack.back(), level = entry >> level_shift;
    const std::size_t first = static_cast<std::size_t>(entry & ((1U << level_shift) - 1)) * block_edges;
    stack.pop_back();
    ++scratch.counts.nodes;
    for (uint32_t bits = nodes_that_matter(s.levels()[level].v.data(), first, box, light); bits;
         bits &= bits - 1) {
      const auto node = static_cast<uint32_t>(first) + static_cast<uint32_t>(__builtin_ctz(bits));
      if (level == 0)
        found.push_back(node);
      else
        stack.push_back((level - 1) << level_shift | node);
    }
  }
  const std::size_t padded = (found.size() + block_edges - 1) / block_edges * block_edges;
  for (std::size_t f = 0; f < node_fields; ++f) {
    std::vector<float>& to = scratch.found_nodes[f];
    if (to.size() < padded) to.resize(padded + padded / 2);
    const float* from = s.levels().front().v[f].data();
    for (std::size_t i = 0; i < found.size(); ++i) to[i] = from[found[i]];
    for (std::size_t i = found.size(); i < padded; ++i) to[i] = f <= lo_z ? 1e30F : f <= hi_z ? -1e30F : 0.0F;
  }
}

// Edges `from` a block or a list that can matter to the box's view samples, added to the list.
template <class From>
HWY_INLINE void keep_edges(const From& from, std::size_t count, bool coarse, const PointBox& box,
                           const LightSpace& light, EdgeList& out) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto load = [&](Field f) HWY_ATTR { return hn::LoadU(d, from(f) + i); };
    Mask keep = edges_that_matter(load, box, light, coarse);
    if (i + lanes > count) keep = hn::And(keep, hn::FirstN(d, count - i));
    if (hn::AllFalse(d, keep)) continue;
    const Packing packing(keep);
    for (int f = 0; f < fields; ++f) packing.store(load(static_cast<Field>(f)), out.v[f].data() + out.count);
    out.count += packing.count();
  }
}

HWY_INLINE void edges_of_blocks(const Silhouettes& s, const PointBox& box, const LightSpace& light,
                                Scratch& scratch) {
  EdgeList& out = scratch.middle;
  out.count = 0;
  for (std::size_t first = 0; first < scratch.found.size(); first += block_edges) {
    ++scratch.counts.blocks_tested;
    for (uint32_t bits = nodes_that_matter(scratch.found_nodes, first, box, light); bits; bits &= bits - 1) {
      const Block& block = s.blocks()[scratch.found[first + static_cast<std::size_t>(__builtin_ctz(bits))]];
      ++scratch.counts.blocks_entered;
      out.reserve(out.count + block_edges);
      keep_edges([&](Field f) HWY_ATTR { return block.v[f]; }, block_edges, true, box, light, out);
    }
  }
}

// Where a set's samples are seen from P. Those in one plane always lie at the same place.
HWY_INLINE View view_of_set(const LightSpace& light, const ViewPoint& p, Scratch& scratch) {
  View view{p, light.lo.x, light.hi.x, light.lo.y, light.hi.y, 0};
  if (light.planar) return view;
  const Floats d;
  const std::size_t n = light.points_x.size();
  if (scratch.projected_x.size() < n) scratch.projected_x.resize(n), scratch.projected_y.resize(n);
  const Vector pz = set(p.z);
  Vector lo_x_ = set(1e30F), hi_x_ = set(-1e30F), lo_y_ = lo_x_, hi_y_ = hi_x_;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const Vector scale = hn::Div(pz, hn::Sub(pz, hn::LoadU(d, light.points_z.data() + i)));
    const auto place = [&](const std::vector<float>& from, float origin, std::vector<float>& to) HWY_ATTR {
      const Vector o = set(origin);
      const Vector at = hn::Add(o, hn::Mul(hn::Sub(hn::LoadU(d, from.data() + i), o), scale));
      hn::StoreU(at, d, to.data() + i);
      return at;
    };
    const Vector x = place(light.points_x, p.x, scratch.projected_x),
                 y = place(light.points_y, p.y, scratch.projected_y);
    lo_x_ = hn::Min(lo_x_, x), hi_x_ = hn::Max(hi_x_, x), lo_y_ = hn::Min(lo_y_, y),
    hi_y_ = hn::Max(hi_y_, y);
  }
  constexpr float margin = 1.0F / 64;
  view.x_lo = hn::GetLane(hn::MinOfLanes(d, lo_x_)) - margin,
  view.x_hi = hn::GetLane(hn::MaxOfLanes(d, hi_x_)) + margin;
  view.y_lo = hn::GetLane(hn::MinOfLanes(d, lo_y_)) - margin,
  view.y_hi = hn::GetLane(hn::MaxOfLanes(d, hi_y_)) + margin;
  return view;
}

template <bool grid>
HWY_INLINE bool candidates_of(const LightSpace& light, const ViewPoint& p, Scratch& scratch,
                              uint64_t* words) {
  View view =
      grid ? View{p, 0, static_cast<float>(light.columns - 1), 0, static_cast<float>(light.rows - 1), 0}
           : view_of_set(light, p, scratch);
  view.tiny = light.magnitude * 1e-12F;
  Crossings& c = scratch.crossings;
  find_crossings<grid>(scratch.small, view, c);
  scratch.counts.crossings += c.count;
  if (c.count + c.events == 0) return false;
  // Each adds 2 at most.
  const std::size_t most = 2 * (c.count + c.events);
  if constexpr (grid) {
    const int w = light.columns, h = light.rows;
    const auto count_in = [&](auto* counters, auto bias) HWY_ATTR {
      auto* const sums = reinterpret_cast<decltype(counters)>(scratch.sums);
      if (w <= 16)
        grid_candidates<16>(c, w, h, bias, counters, sums, words);
      else if (w <= 32)
        grid_candidates<32>(c, w, h, bias, counters, sums, words);
      else
        grid_candidates<64>(c, w, h, bias, counters, sums, words);
    };
    // Counters lie between -fall and most - fall, and 127 is for places that no sample owns.
    scratch.counts.wide += most > 252;
    if (most <= 126)
      count_in(scratch.counters_8, int8_t{0});
    else if (most <= 252)
      count_in(scratch.counters_8, static_cast<int8_t>(fall_of(c) - 127));
    else if (most <= 32766)
      count_in(scratch.counters_16, int16_t{0});
    else
      grid_candidates<64>(c, w, h, int32_t{0}, scratch.counters_32, reinterpret_cast<int32_t*>(scratch.sums),
                          words);
  } else {
    const bool moves = !light.planar;
    set_candidates(c, moves ? scratch.projected_x.data() : light.points_x.data(),
                   moves ? scratch.projected_y.data() : light.points_y.data(), light.sample_count,
                   scratch.counters_32, words);
  }
  return true;
}

template <bool grid>
HWY_INLINE void walk(const Occluders& scene, const ViewPoint* points, std::size_t count, Scratch& scratch) {
  const LightSpace& light = *scene.light;
  find_blocks(*scene.silhouettes, box_of(points, count, light), light, scratch);
  for (std::size_t m = 0; m < count; m += middle_group) {
    const std::size_t middle_count = std::min(middle_group, count - m);
    edges_of_blocks(*scene.silhouettes, box_of(points + m, middle_count, light), light, scratch);
    for (std::size_t g = m; g < m + middle_count; g += small_group) {
      const std::size_t n = std::min(small_group, m + middle_count - g);
      EdgeList& edges = scratch.small;
      edges.count = 0;
      edges.reserve(scratch.middle.count);
      keep_edges([&](Field f) HWY_ATTR { return scratch.middle.v[f].data(); }, scratch.middle.count, false,
                 box_of(points + g, n, light), light, edges);
      scratch.crossings.reserve(edges.count);
      scratch.counts.view_samples += n, ++scratch.counts.small_groups;
      scratch.counts.edges_tested += n * edges.count;
      for (std::size_t p = 0; p < n; ++p) {
        Candidates& c = scratch.candidates;
        c.parted[p] = edges.count != 0 && candidates_of<grid>(light, points[g + p], scratch, c.words[p]);
        scratch.counts.unparted += !c.parted[p];
      }
      scene.judge->judge(points + g, n, scratch);
    }
  }
}

}  // namespace penumbra::depth_complexity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
