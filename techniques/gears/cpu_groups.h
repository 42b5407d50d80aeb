// backend: cpu. The view samples of a cell in groups of neighbours: a cell with a silhouette in it holds
// samples before and behind it, and what one of them sees of the light has little to do with the other.
#pragma once
#include <algorithm>
#include <cstddef>

#include "techniques/gears/cpu_kernel.h"

namespace penumbra::gears::cpu {

inline constexpr std::size_t group_size = 16;

// Cut again and again across the longest side, at multiples of the group's size.
inline void order_groups(ViewPoint* p, std::size_t n) {
  if (n <= group_size) return;
  const std::size_t half = std::max(group_size, (n / 2 + group_size / 2) / group_size * group_size);
  float lo[3] = {p->x, p->y, p->z}, hi[3] = {p->x, p->y, p->z};
  for (std::size_t i = 1; i < n; ++i) {
    const float v[3] = {p[i].x, p[i].y, p[i].z};
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], v[k]), hi[k] = std::max(hi[k], v[k]);
  }
  const float size[3] = {hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]};
  float ViewPoint::*const axis = size[0] >= size[1] && size[0] >= size[2] ? &ViewPoint::x
                                 : size[1] >= size[2]                     ? &ViewPoint::y
                                                                          : &ViewPoint::z;
  std::nth_element(p, p + half, p + n, [axis](const ViewPoint& a, const ViewPoint& b) {
    return a.*axis != b.*axis ? a.*axis < b.*axis : a.pixel < b.pixel;
  });
  order_groups(p, half);
  order_groups(p + half, n - half);
}

// body(begin, count) for each group.
template <class F>
void each_group(std::size_t n, const F& body) {
  for (std::size_t begin = 0; begin < n; begin += group_size) body(begin, std::min(group_size, n - begin));
}

}  // namespace penumbra::gears::cpu
