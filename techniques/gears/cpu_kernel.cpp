#include "techniques/gears/cpu_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "techniques/gears/cpu_kernel.cpp"
#include <hwy/foreach_target.h>  // compiles this file once per instruction set
#include <hwy/highway.h>

#include "techniques/gears/cpu_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::gears::cpu::HWY_NAMESPACE {

void walk_tree_here(const Occluders& scene, const ViewPoint* points, std::size_t count, Scratch& scratch) {
  with_mask_of(*scene.light, [&](auto type) HWY_ATTR {
    walk_tree_as<typename decltype(type)::type>(scene, points, count, scratch);
  });
}
void walk_cell_here(const Occluders& scene, std::size_t triangles, const ViewPoint* points, std::size_t count,
                    Scratch& scratch) {
  with_mask_of(*scene.light, [&](auto type) HWY_ATTR {
    walk_cell_as<typename decltype(type)::type>(scene, triangles, points, count, scratch);
  });
}
const char* name_of_target() { return hwy::TargetName(HWY_TARGET); }
int lanes_of_target() { return static_cast<int>(hn::Lanes(Floats())); }

}  // namespace penumbra::gears::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace penumbra::gears::cpu {

HWY_EXPORT(walk_tree_here);
HWY_EXPORT(walk_cell_here);
HWY_EXPORT(name_of_target);
HWY_EXPORT(lanes_of_target);

void walk_tree(const Occluders& scene, const ViewPoint* points, std::size_t count, Scratch& scratch) {
  HWY_DYNAMIC_DISPATCH(walk_tree_here)(scene, points, count, scratch);
}
void walk_cell(const Occluders& scene, std::size_t triangles, const ViewPoint* points, std::size_t count,
               Scratch& scratch) {
  HWY_DYNAMIC_DISPATCH(walk_cell_here)(scene, triangles, points, count, scratch);
}
std::string instruction_set() { return HWY_DYNAMIC_DISPATCH(name_of_target)(); }
int vector_lanes() { return HWY_DYNAMIC_DISPATCH(lanes_of_target)(); }

void WorkCounts::add(const WorkCounts& o) {
  view_samples += o.view_samples, groups += o.groups, nodes += o.nodes, blocks_found += o.blocks_found;
  blocks_entered += o.blocks_entered, pairs += o.pairs, listed += o.listed;
}

void Scratch::grow_like(const Scratch& o) {
  const auto as = [](auto& mine, const auto& other) {
    if (mine.size() < other.size()) mine.resize(other.size());
  };
  stack.reserve(o.stack.capacity()), found.reserve(o.found.capacity());
  for (std::size_t f = 0; f < box_fields; ++f) as(found_boxes[f], o.found_boxes[f]);
  as(sizes, o.sizes), as(ordered, o.ordered), as(points, o.points);
  as(listed, o.listed), as(cell, o.cell);
  as(to_x, o.to_x), as(to_y, o.to_y), as(to_z, o.to_z);
}

uint64_t Scratch::bytes() const {
  uint64_t b =
      sizeof(*this) +
      (stack.capacity() + found.capacity() + sizes.capacity() + ordered.capacity()) * sizeof(uint32_t) +
      (listed.capacity() + cell.capacity()) * sizeof(Block) +
      (to_x.capacity() + to_y.capacity() + to_z.capacity()) * sizeof(float);
  for (const auto& v : found_boxes) b += v.capacity() * sizeof(float);
  return b;
}

}  // namespace penumbra::gears::cpu
#endif
