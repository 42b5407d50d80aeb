// View samples into groups of neighbours, for techniques that run on the host: cut again and again across the
// longest side, at multiples of the groups' size, so that all groups but the last are full.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace penumbra {

// Moves the `half` points that lie lowest along an axis to the front, up to the width of a bin: none is
// compared with another, as a processor cannot guess how that ends.
template <class Point>
void part_points(Point* points, Point* spare, std::size_t n, std::size_t half, float Point::*axis, float lo,
                 float size) {
  constexpr int bins = 64;
  const float scale = size > 0 ? static_cast<float>(bins) / size : 0;
  const auto bin_of = [&](const Point& p) {
    return std::clamp(static_cast<int>((p.*axis - lo) * scale), 0, bins - 1);
  };
  uint32_t count[bins] = {};
  for (std::size_t i = 0; i < n; ++i) ++count[bin_of(points[i])];
  int middle = 0;
  std::size_t below = 0;
  while (below + count[middle] < half) below += count[middle++];
  // Of the bin in the middle the first ones are still needed.
  std::size_t needed = half - below, low = 0, high = half;
  for (std::size_t i = 0; i < n; ++i) {
    const int bin = bin_of(points[i]);
    const bool at_middle = bin == middle, is_low = bin < middle || (at_middle && needed > 0);
    needed -= at_middle && needed > 0 ? 1 : 0;
    std::size_t& at = is_low ? low : high;
    spare[at++] = points[i];
  }
  std::copy_n(spare, n, points);
}

// unit(n): the multiple to cut a run of n points at; 0: it is a group. `spare` has room for n points.
template <class Point, class Unit>
void order_in_groups(Point* points, Point* spare, std::size_t n, const Unit& unit_of) {
  const std::size_t unit = unit_of(n);
  if (unit == 0) return;
  const std::size_t half = std::max(unit, (n / 2 + unit / 2) / unit * unit);
  float lo[3] = {points->x, points->y, points->z}, hi[3] = {points->x, points->y, points->z};
  for (std::size_t i = 1; i < n; ++i) {
    const float v[3] = {points[i].x, points[i].y, points[i].z};
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], v[k]), hi[k] = std::max(hi[k], v[k]);
  }
  const float size[3] = {hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]};
  const int longest = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
  constexpr float Point::*axes[] = {&Point::x, &Point::y, &Point::z};
  part_points(points, spare, n, half, axes[longest], lo[longest], size[longest]);
  order_in_groups(points, spare, half, unit_of);
  order_in_groups(points + half, spare, n - half, unit_of);
}

}  // namespace penumbra
