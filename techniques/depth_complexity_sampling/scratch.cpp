#include "techniques/depth_complexity_sampling/kernel.h"

namespace penumbra::depth_complexity {
namespace {

void grow(std::vector<float>* v, std::size_t fields_of, std::size_t n) {
  if (v[0].size() >= n) return;
  for (std::size_t f = 0; f < fields_of; ++f) v[f].resize(n + n / 2);
}

template <class T>
uint64_t bytes_of(const std::vector<T>* v, std::size_t n) {
  uint64_t b = 0;
  for (std::size_t f = 0; f < n; ++f) b += v[f].capacity() * sizeof(T);
  return b;
}

}  // namespace

void EdgeList::grow_to(std::size_t n) { grow(v, fields, n); }
void Crossings::grow_to(std::size_t n) { grow(v, crossing_fields, n); }

void WorkCounts::add(const WorkCounts& o) {
  view_samples += o.view_samples, small_groups += o.small_groups, nodes += o.nodes;
  blocks_tested += o.blocks_tested, blocks_entered += o.blocks_entered, edges_tested += o.edges_tested;
  crossings += o.crossings, unparted += o.unparted, wide += o.wide, rays += o.rays,
      extra_rays += o.extra_rays, traced += o.traced;
}

void Scratch::grow_like(const Scratch& o) {
  stack.reserve(o.stack.capacity()), found.reserve(o.found.capacity());
  for (std::size_t f = 0; f < node_fields; ++f)
    if (found_nodes[f].size() < o.found_nodes[f].size()) found_nodes[f].resize(o.found_nodes[f].size());
  const auto as = [](auto& mine, const auto& other) {
    for (std::size_t f = 0; f < std::size(mine.v); ++f)
      if (mine.v[f].size() < other.v[f].size()) mine.v[f].resize(other.v[f].size());
  };
  as(middle, o.middle), as(small, o.small), as(crossings, o.crossings);
  if (projected_x.size() < o.projected_x.size())
    projected_x.resize(o.projected_x.size()), projected_y.resize(o.projected_x.size());
}

uint64_t Scratch::bytes() const {
  return sizeof(*this) + bytes_of(&stack, 1) + bytes_of(&found, 1) + bytes_of(found_nodes, node_fields) +
         bytes_of(middle.v, fields) + bytes_of(small.v, fields) + bytes_of(crossings.v, crossing_fields) +
         bytes_of(&projected_x, 1) + bytes_of(&projected_y, 1);
}

}  // namespace penumbra::depth_complexity
