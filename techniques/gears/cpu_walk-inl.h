// From a group of view samples to their masks: per instruction set.
#if defined(PENUMBRA_GEARS_CPU_WALK) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_GEARS_CPU_WALK
#undef PENUMBRA_GEARS_CPU_WALK
#else
#define PENUMBRA_GEARS_CPU_WALK
#endif
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

// Blocks that may matter to the group, and their boxes side by side.
template <bool grid>
HWY_INLINE void find_blocks(const Occluders& scene, const Window<grid>& window, Scratch& scratch) {
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

template <bool grid, bool crossing>
HWY_INLINE void rasterise(const Block& block, const ViewPoint& p, const LightView& light,
                          [[maybe_unused]] const Window<grid>& window, Scratch& scratch) {
  if constexpr (grid)
    rasterise_on_grid<crossing>(block, p, light, scratch);
  else
    rasterise_on_set(block, p, light, window, scratch);
}

// Blocks whose boxes may hide a light sample that is still open.
template <bool grid>
HWY_INLINE void rasterise_found(const Occluders& scene, const ViewPoint& p, const PointBox& box,
                                const Window<grid>& window, Scratch& scratch) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const LightView& light = *scene.light;
  const std::size_t lanes = hn::Lanes(d);
  alignas(64) int32_t c0[block_size], c1[block_size], r0[block_size], r1[block_size];
  for (std::size_t o = 0; o < scratch.found.size(); o += lanes) {
    const BoxVectors boxes = load_boxes(scratch.found_boxes, o);
    uint32_t bits;
    if constexpr (grid) {
      const Rectangles rect = rectangles_of(boxes, box, light);
      bits = bits_of(rect.some);
      if (!bits) continue;
      hn::Store(hn::ConvertTo(di, rect.c0), di, c0), hn::Store(hn::ConvertTo(di, rect.c1), di, c1);
      hn::Store(hn::ConvertTo(di, rect.r0), di, r0), hn::Store(hn::ConvertTo(di, rect.r1), di, r1);
    } else {
      bits = bits_of(window.meets(boxes));
    }
    bool entered = false;
    for (; bits; bits &= bits - 1) {
      const auto l = static_cast<std::size_t>(__builtin_ctz(bits));
      if constexpr (grid)
        if (!is_open(scratch.mask, c0[l], c1[l], r0[l], r1[l], light.parts)) continue;
      ++scratch.counts.blocks_entered;
      entered = true;
      rasterise<grid, false>(scene.blocks[scratch.found[o + l]], p, light, window, scratch);
    }
    if (entered && all_blocked<grid>(light, scratch.mask)) return;
  }
}

// One view sample's mask, but for begin and write: the triangles of the list, then whatever `rest` adds.
template <bool grid, class Rest>
HWY_INLINE void make_mask(const Occluders& scene, const ViewPoint& p, Scratch& scratch, const Rest& rest) {
  const LightView& light = *scene.light;
  if (scene.masks->begin(p.pixel, scratch.mask)) {
    const PointBox box = box_of(&p, 1);
    const Window<grid> window(box, light);
    if constexpr (!grid) look_at_set(light, p, scratch);
    for (std::size_t i = 0; i < scratch.listed_count; i += block_size)
      rasterise<grid, true>(scratch.listed[i / block_size], p, light, window, scratch);
    if (scratch.listed_count == 0 || !all_blocked<grid>(light, scratch.mask)) rest(box, window);
  }
  scene.masks->write(p.pixel, scratch.mask);
}

template <bool grid>
HWY_INLINE void walk_tree_as(const Occluders& scene, const ViewPoint* points, std::size_t count,
                             Scratch& scratch) {
  const PointBox box = box_of(points, count);
  const Window<grid> window(box, *scene.light);
  find_blocks<grid>(scene, window, scratch);
  choose_listed<grid>(scene, box, window, scratch);
  ++scratch.counts.groups, scratch.counts.view_samples += count;
  for (std::size_t i = 0; i < count; ++i)
    make_mask<grid>(scene, points[i], scratch,
                    [&](const PointBox& at, const Window<grid>& of_sample)
                        HWY_ATTR { rasterise_found<grid>(scene, points[i], at, of_sample, scratch); });
}

template <bool grid>
HWY_INLINE void walk_cell_as(const Occluders& scene, std::size_t triangles, const ViewPoint* points,
                             std::size_t count, Scratch& scratch) {
  const PointBox box = box_of(points, count);
  const Window<grid> window(box, *scene.light);
  choose_listed<grid>(scene, box, window, scratch);
  ++scratch.counts.groups, scratch.counts.view_samples += count;
  for (std::size_t i = 0; i < count; ++i)
    make_mask<grid>(scene, points[i], scratch, [&](const PointBox&, const Window<grid>& of_sample) HWY_ATTR {
      for (std::size_t t = 0; t < triangles; t += block_size) {
        rasterise<grid, false>(scratch.cell[t / block_size], points[i], *scene.light, of_sample, scratch);
        if (t % (4 * block_size) == 0 && all_blocked<grid>(*scene.light, scratch.mask)) return;
      }
    });
}

}  // namespace penumbra::gears::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
