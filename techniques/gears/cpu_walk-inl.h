// From a group of view samples to their masks: per instruction set.
#if defined(PENUMBRA_GEARS_CPU_WALK) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_GEARS_CPU_WALK
#undef PENUMBRA_GEARS_CPU_WALK
#else
#define PENUMBRA_GEARS_CPU_WALK
#endif
#include <bit>
#include <type_traits>

#include "techniques/gears/cpu_masks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::gears::cpu::HWY_NAMESPACE {

// Boxes against the light as a group of view samples sees it, a grid of light samples or a set of them.
class GridWindow {
 public:
  HWY_INLINE GridWindow(const PointBox& p, const LightView& light) : p_(p), light_(light) {}
  HWY_INLINE Mask meets(const BoxVectors& b) const { return rectangles_of(b, p_, light_).some; }

 private:
  const PointBox& p_;
  const LightView& light_;
};
template <bool grid>
using Window = std::conditional_t<grid, GridWindow, Hull>;

HWY_INLINE BoxVectors load_boxes(const Boxes& boxes, std::size_t at) {
  BoxVectors b;
  for (int f = 0; f < box_fields; ++f)
    b.v[f] = hn::LoadU(Floats(), boxes[static_cast<std::size_t>(f)].data() + at);
  return b;
}

// Orders the blocks found by how much of the light their boxes' sides towards it cover, in steps of a half
// power of two: what covers much comes first, and then need not be asked for by what it hides.
HWY_INLINE void largest_first(const Boxes& boxes, float height, Scratch& scratch) {
  constexpr std::size_t steps = 64;
  const std::size_t n = scratch.found.size();
  if (scratch.ordered.size() < n) scratch.ordered.resize(n + n / 2), scratch.sizes.resize(n + n / 2);
  uint32_t most = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const uint32_t node = scratch.found[i];
    const auto side = [&](BoxField lo) { return boxes[lo + 3][node] - boxes[lo][node]; };
    const float above = std::max(height - boxes[lo_z][node], 1e-6F * height);
    scratch.sizes[i] = std::bit_cast<uint32_t>(side(lo_x) * side(lo_y) / (above * above)) >> 22;
    most = std::max(most, scratch.sizes[i]);
  }
  uint32_t place[steps + 1] = {};
  for (std::size_t i = 0; i < n; ++i) {
    scratch.sizes[i] = std::min<uint32_t>(most - scratch.sizes[i], steps - 1);
    ++place[scratch.sizes[i] + 1];
  }
  for (std::size_t s = 0; s < steps; ++s) place[s + 1] += place[s];
  for (std::size_t i = 0; i < n; ++i) scratch.ordered[place[scratch.sizes[i]]++] = scratch.found[i];
  std::copy_n(scratch.ordered.begin(), n, scratch.found.begin());
}

// Blocks that may matter to the group, and their boxes side by side.
template <bool grid>
HWY_INLINE void find_blocks(const Occluders& scene, [[maybe_unused]] const PointBox& box,
                            const Window<grid>& window, Scratch& scratch) {
  std::vector<uint32_t>&stack = scratch.stack, &found = scratch.found;
  stack.clear(), found.clear();
  stack.push_back(0);
  while (!stack.empty()) {
    const uint32_t first = stack.back() * static_cast<uint32_t>(block_size) + 1;
    stack.pop_back();
    ++scratch.counts.nodes;
    const bool leaves = first >= scene.first_leaf;
    for (std::size_t i = 0; i < block_size; i += hn::Lanes(Floats()))
      for (uint32_t bits = bits_of(window.meets(load_boxes(*scene.boxes, first + i))); bits;
           bits &= bits - 1) {
        const uint32_t node = first + static_cast<uint32_t>(i) + static_cast<uint32_t>(__builtin_ctz(bits));
        if (leaves)
          found.push_back(node);
        else
          stack.push_back(node);
      }
  }
  if constexpr (grid) largest_first(*scene.boxes, box.hi[2], scratch);
  const std::size_t padded = (found.size() + block_size - 1) / block_size * block_size;
  for (std::size_t f = 0; f < box_fields; ++f) {
    std::vector<float>& to = scratch.found_boxes[f];
    if (to.size() < padded) to.resize(padded + padded / 2);
    const float* from = (*scene.boxes)[f].data();
    for (std::size_t i = 0; i < found.size(); ++i) to[i] = from[found[i]];
    for (std::size_t i = found.size(); i < padded; ++i) to[i] = f <= lo_z ? 1e30F : -1e30F;
  }
  for (uint32_t& node : found) node -= scene.first_leaf;
  scratch.counts.blocks_found += found.size();
}

// Whether the planes of triangles part the light from all view samples of the group, so that they hide
// nothing: for a ground's large triangles, which reach through the light's plane.
template <class Load>
HWY_INLINE Mask planes_part(const Load& load, const PointBox& p, const LightView& light) {
  const auto corner = [&](int x) HWY_ATTR { return Vector3{load(x), load(x + 1), load(x + 2)}; };
  const Vector3 a = corner(ax), n = edge_normal(minus(corner(bx), a), minus(corner(cx), a));
  const Vector normal[3] = {n.x, n.y, n.z}, at[3] = {a.x, a.y, a.z}, pad = set(light.pad);
  const float light_hi[3] = {static_cast<float>(light.columns - 1), static_cast<float>(light.rows - 1), 0};
  Vector below = set(0), above = set(0), light_below = set(0), light_above = set(0);
  for (int k = 0; k < 3; ++k) {
    const auto add = [&](float lo, float hi, Vector* least_, Vector* most) HWY_ATTR {
      const Vector u = hn::Mul(normal[k], hn::Sub(hn::Sub(set(lo), at[k]), pad)),
                   v = hn::Mul(normal[k], hn::Add(hn::Sub(set(hi), at[k]), pad));
      *least_ = hn::Add(*least_, hn::Min(u, v)), *most = hn::Add(*most, hn::Max(u, v));
    };
    add(p.lo[k], p.hi[k], &below, &above);
    add(0, light_hi[k], &light_below, &light_above);
  }
  const Vector size =
      hn::Add(hn::Add(hn::Abs(below), hn::Abs(above)), hn::Add(hn::Abs(light_below), hn::Abs(light_above)));
  const Vector error = hn::Mul(set(1e-5F), size), minus_error = hn::Neg(error);
  return hn::Or(hn::And(hn::Gt(below, error), hn::Gt(light_below, error)),
                hn::And(hn::Lt(above, minus_error), hn::Lt(light_above, minus_error)));
}

// Triangles of the list that may matter to the group, packed.
template <bool grid>
HWY_INLINE void choose_listed(const Occluders& scene, const PointBox& box, const Window<grid>& window,
                              Scratch& scratch) {
  scratch.listed_count = 0;
  for (std::size_t first = 0; first < scene.listed_count; first += block_size) {
    const Block& block = scene.listed[first / block_size];
    for (std::size_t i = 0; i < block_size; i += hn::Lanes(Floats())) {
      const auto load = [&](int x) HWY_ATTR { return hn::Load(Floats(), block.v[x] + i); };
      Mask use = window.meets(box_of_triangles(load));
      if constexpr (grid) use = hn::AndNot(planes_part(load, box, *scene.light), use);
      for (uint32_t bits = bits_of(use); bits; bits &= bits - 1) {
        const std::size_t from = i + static_cast<std::size_t>(__builtin_ctz(bits)),
                          to = scratch.listed_count++;
        if (to % block_size == 0 && scratch.listed.size() <= to / block_size)
          scratch.listed.resize(to / block_size + 1 + to / block_size / 2);
        for (int f = 0; f < corner_fields; ++f)
          scratch.listed[to / block_size].v[f][to % block_size] = block.v[f][from];
      }
    }
  }
  for (std::size_t to = scratch.listed_count; to % block_size != 0; ++to)
    for (int f = 0; f < corner_fields; ++f)
      scratch.listed[to / block_size].v[f][to % block_size] = nowhere[f % 3];
  scratch.counts.listed += scratch.listed_count;
}

// The blocks of a group whose boxes may hide a light sample that is still open.
struct FoundBlocks {
  const Occluders& scene;
  Scratch& scratch;

  template <class M>
  HWY_INLINE void add_to(M& mask, const PointBox& box, const Window<M::grid>& window) const {
    const std::size_t lanes = hn::Lanes(Floats());
    Ranges ranges{};
    for (std::size_t o = 0; o < scratch.found.size(); o += lanes) {
      uint32_t bits = meeting<M>(load_boxes(scratch.found_boxes, o), box, window, ranges);
      bool entered = false;
      for (; bits; bits &= bits - 1) {
        const auto l = static_cast<std::size_t>(__builtin_ctz(bits));
        if constexpr (M::grid)
          if (!mask.is_open({ranges.c0[l], ranges.c1[l], ranges.r0[l], ranges.r1[l]})) continue;
        ++scratch.counts.blocks_entered;
        entered = true;
        mask.template add<false>(scene.blocks[scratch.found[o + l]], window);
      }
      if (entered && mask.all_blocked()) return;
    }
  }

 private:
  struct Ranges {
    alignas(64) int32_t c0[block_size], c1[block_size], r0[block_size], r1[block_size];
  };
  template <class M>
  HWY_INLINE uint32_t meeting(const BoxVectors& boxes, const PointBox& box, const Window<M::grid>& window,
                              [[maybe_unused]] Ranges& ranges) const {
    if constexpr (!M::grid) {
      return bits_of(window.meets(boxes));
    } else {
      const hn::RebindToSigned<Floats> di;
      const Rectangles rect = rectangles_of(boxes, box, *scene.light);
      const uint32_t bits = bits_of(rect.some);
      if (bits == 0) return bits;
      hn::Store(hn::ConvertTo(di, rect.c0), di, ranges.c0),
          hn::Store(hn::ConvertTo(di, rect.c1), di, ranges.c1);
      hn::Store(hn::ConvertTo(di, rect.r0), di, ranges.r0),
          hn::Store(hn::ConvertTo(di, rect.r1), di, ranges.r1);
      return bits;
    }
  }
};

// The triangles of a cell.
struct CellTriangles {
  std::size_t count;
  Scratch& scratch;

  template <class M>
  HWY_INLINE void add_to(M& mask, const PointBox&, const Window<M::grid>& window) const {
    for (std::size_t t = 0; t < count; t += block_size) {
      mask.template add<false>(scratch.cell[t / block_size], window);
      if (t % (4 * block_size) == 0 && mask.all_blocked()) return;
    }
  }
};

// The masks of a group: the triangles of the list, then those of `from`.
template <class M, class From>
HWY_INLINE void make_masks(const Occluders& scene, const From& from, const ViewPoint* points,
                           std::size_t count, Scratch& scratch) {
  const LightView& light = *scene.light;
  ++scratch.counts.groups, scratch.counts.view_samples += count;
  for (std::size_t i = 0; i < count; ++i) {
    const ViewPoint& p = points[i];
    if (scene.masks->begin(p.pixel, scratch.mask)) {
      const PointBox box = box_of(&p, 1);
      const Window<M::grid> window(box, light);
      M mask(light, p, scratch);
      for (std::size_t t = 0; t < scratch.listed_count; t += block_size)
        mask.template add<true>(scratch.listed[t / block_size], window);
      if (scratch.listed_count == 0 || !mask.all_blocked()) from.add_to(mask, box, window);
      mask.finish();
    }
    scene.masks->write(p.pixel, scratch.mask);
  }
}

template <class M>
HWY_NOINLINE void walk_tree_as(const Occluders& scene, const ViewPoint* points, std::size_t count,
                               Scratch& scratch) {
  const PointBox box = box_of(points, count);
  const Window<M::grid> window(box, *scene.light);
  find_blocks<M::grid>(scene, box, window, scratch);
  choose_listed<M::grid>(scene, box, window, scratch);
  make_masks<M>(scene, FoundBlocks{scene, scratch}, points, count, scratch);
}

template <class M>
HWY_NOINLINE void walk_cell_as(const Occluders& scene, std::size_t triangles, const ViewPoint* points,
                               std::size_t count, Scratch& scratch) {
  const PointBox box = box_of(points, count);
  const Window<M::grid> window(box, *scene.light);
  choose_listed<M::grid>(scene, box, window, scratch);
  make_masks<M>(scene, CellTriangles{triangles, scratch}, points, count, scratch);
}

// walk(type of mask) with the one that fits the light.
template <class M>
struct MaskType {
  using type = M;
};
template <class Walk>
HWY_INLINE void with_mask_of(const LightView& light, const Walk& walk) {
  if (!light.grid) return walk(MaskType<SetMask>());
#if !HWY_HAVE_SCALABLE
  constexpr std::size_t lanes = hn::MaxLanes(Floats()), most = 4;
  [[maybe_unused]] const auto rows = static_cast<std::size_t>(light.rows);
  if constexpr (16 / lanes <= most)
    if (light.parts == 1 && rows <= 16) return walk(MaskType<GridMask<RowsInRegisters<16 / lanes>>>());
  if constexpr (32 / lanes <= most)
    if (light.parts == 1 && rows <= 32) return walk(MaskType<GridMask<RowsInRegisters<32 / lanes>>>());
#endif
  walk(MaskType<GridMask<RowsInMemory>>());
}

}  // namespace penumbra::gears::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
