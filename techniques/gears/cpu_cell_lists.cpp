#include "techniques/gears/cpu_cell_lists.h"

#include <algorithm>

namespace penumbra::gears::cpu {

void CellLists::Worker::count(const std::vector<CellRange>& triangles, std::size_t row, std::size_t size) {
  if (in_row.size() < triangles.size()) in_row.reserve(triangles.size());
  in_row.clear();
  starts.assign(size + 2, 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const CellRange c = triangles[t];
    if (row < c.y0 || row > c.y1) continue;
    in_row.push_back(static_cast<uint32_t>(t));
    // Differences: unsigned, so that taking away wraps around and comes back.
    ++starts[c.x0 + 1], --starts[std::size_t{c.x1} + 2 > size + 1 ? size + 1 : std::size_t{c.x1} + 2];
  }
  std::size_t here = 0, sum = 0;
  for (std::size_t x = 0; x <= size; ++x) {
    here += starts[x];
    starts[x] = sum += here;
    most = std::max<uint64_t>(most, here);
  }
  starts.resize(size + 1);
  assignments += starts[size];
}

std::size_t CellLists::Worker::fill(const std::vector<CellRange>& triangles, std::size_t begin,
                                    std::size_t budget) {
  const std::size_t size = starts.size() - 1;
  std::size_t end = begin + 1;
  while (end < size && starts[end + 1] - starts[begin] <= budget) ++end;
  first = begin;
  at.assign(starts.begin(), starts.end());
  const std::size_t needed = starts[end] - starts[begin];
  if (entries.size() < needed) entries.resize(needed + needed / 4);
  for (const uint32_t t : in_row) {
    const CellRange c = triangles[t];
    const std::size_t from = std::max<std::size_t>(c.x0, begin),
                      to = std::min<std::size_t>(c.x1 + std::size_t{1}, end);
    for (std::size_t x = from; x < to; ++x) entries[at[x]++ - starts[begin]] = t;
  }
  return end;
}

void CellLists::Worker::grow_like(const Worker& o) {
  in_row.reserve(o.in_row.capacity()), starts.reserve(o.starts.capacity()), at.reserve(o.at.capacity());
  if (entries.size() < o.entries.size()) entries.resize(o.entries.size());
}

uint64_t CellLists::Worker::bytes() const {
  return (in_row.capacity() + entries.capacity()) * sizeof(uint32_t) +
         (starts.capacity() + at.capacity()) * sizeof(std::size_t);
}

}  // namespace penumbra::gears::cpu
