// A line space tree on the host, and its parameters: what the room's tests share.
#pragma once
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "techniques/line_space/host_tracer.h"
#include "techniques/line_space/line_space.h"
#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"

namespace penumbra::test {

using namespace line_space;

inline line_space::Params params_of(int branching, int depth) {
  line_space::Params p;
  p.branching = branching, p.depth = depth;
  return p;
}

// A tree on the host.
struct Tree {
  Tree(const Geometry& geometry, const std::vector<uint32_t>& casters, const line_space::Params& params)
      : grid(make_grid(geometry, casters, params)),
        table(grid.branching),
        pools(build_tree(geometry, casters, grid, table, params.memory_limit_mib)),
        start(params.start),
        tracer(pools, grid, params.start) {}
  Tree(const Geometry& geometry, const line_space::Params& params)
      : Tree(geometry, select_casters(geometry, 0), params) {}
  Tree(const Tree&) = delete;
  // World coordinate of the border between fine cells i - 1 and i.
  double border(int axis, double i) const {
    return double(grid.lo[axis]) + i * double(grid.size[axis]) / grid.fine_cells();
  }

  // First and last fine cell, along one axis, of what is skipped for a segment that begins in `cell`.
  std::pair<double, double> skipped(double cell) const {
    if (start == line_space::Params::Start::neighbours) return {cell - 1, cell + 1};
    if (start != line_space::Params::Start::coarse || grid.depth < 3) return {cell, cell};
    const double size = double(grid.fine_cells() / grid.branching), first = std::floor(cell / size) * size;
    return {first, first + size - 1};
  }

  Grid grid;
  ShaftTable table;
  Pools pools;
  line_space::Params::Start start;
  HostTracer tracer;
};

inline Geometry soup(int count, float size, uint32_t seed) {
  Geometry g;
  testing::add_soup(g, {-1, -0.7f, -0.5f}, {1, 0.8f, 0.6f}, count, size, seed);
  return g;
}

}  // namespace penumbra::test
