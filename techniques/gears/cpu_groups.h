// backend: cpu. The view samples of a cell in groups of neighbours: a cell with a silhouette in it holds
// samples before and behind it, and what one of them sees of the light has little to do with the other.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "techniques/common/point_groups.h"
#include "techniques/gears/cpu_kernel.h"

namespace penumbra::gears::cpu {

inline constexpr std::size_t group_size = 16;

inline void order_groups(std::span<ViewPoint> points, std::vector<ViewPoint>& spare) {
  if (spare.size() < points.size()) spare.resize(points.size() + points.size() / 2);
  order_in_groups(points.data(), spare.data(), points.size(),
                  [](std::size_t n) { return n > group_size ? group_size : 0; });
}

// body(begin, count) for each group.
template <class F>
void each_group(std::size_t n, const F& body) {
  for (std::size_t begin = 0; begin < n; begin += group_size) body(begin, std::min(group_size, n - begin));
}

}  // namespace penumbra::gears::cpu
