// The N-tree with its line spaces in the paper's three pools [Keul2017, sec. 3.1], as host arrays: what the
// host build makes, and what tests read back from the device.
#pragma once
#include <cstdint>
#include <vector>

#include "techniques/line_space/casters.h"
#include "techniques/line_space/shaders/shared.h"
#include "techniques/line_space/shafts.h"

namespace penumbra::line_space {

// Subdivided nodes only, level by level, in each level by parent and then by place in it. The n-th node has
// the n-th children group (N^3 entries: the child's number among the nodes, occupied_leaf or empty_leaf) and
// the n-th line space.
struct Pools {
  std::vector<uint32_t> tree;
  std::vector<Node> nodes;
  std::vector<uint32_t> line_space;
  std::vector<uint32_t> level_begin;  // first node of each level; then the number of nodes
  bool operator==(const Pools&) const;
};

// Bytes of the pools of so many nodes.
struct PoolBytes {
  uint64_t tree = 0, nodes = 0, line_space = 0;
  uint64_t total() const { return tree + nodes + line_space; }
};
PoolBytes pool_bytes(uint32_t branching, uint64_t nodes);

// Throws PointError when pools of so many nodes, or lists of so many pairs of a triangle and a node, are over
// the limit or over what 32-bit places can address.
void check_memory(uint32_t branching, uint64_t nodes, uint64_t pairs, int limit_mib);

// On all host threads.
Pools build_tree(const Geometry& geometry, const std::vector<uint32_t>& casters, const Grid& grid,
                 const ShaftTable& table, int limit_mib);

}  // namespace penumbra::line_space
