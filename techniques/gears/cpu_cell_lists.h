// backend: cpu, assignment: triangles. The cells' lists of triangles, one row of cells after the other, so
// that they never all exist at once; a row whose lists do not fit the budget is done in several turns.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "techniques/gears/cpu_grid.h"

namespace penumbra::gears::cpu {

struct CellLists {
  // One worker's row.
  struct Worker {
    uint64_t assignments = 0, most = 0;  // pairs of triangle and cell; the longest list
    // How many triangles touch each cell of the row.
    void count(const std::vector<CellRange>& triangles, std::size_t row, std::size_t size);
    // Lists of the cells from `begin` on, as many as fit `budget` entries but one at least; returns the first
    // cell without.
    std::size_t fill(const std::vector<CellRange>& triangles, std::size_t begin, std::size_t budget);
    std::span<const uint32_t> list(std::size_t x) const {
      return {entries.data() + (starts[x] - starts[first]), starts[x + 1] - starts[x]};
    }
    void grow_like(const Worker& o);
    uint64_t bytes() const;

    std::size_t first = 0;                // cell of the row that the lists begin with
    std::vector<uint32_t> in_row;         // triangles that touch the row
    std::vector<std::size_t> starts, at;  // of cells: where their lists would begin in one list of the row
    std::vector<uint32_t> entries;
  };
};

}  // namespace penumbra::gears::cpu
