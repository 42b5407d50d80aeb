// The order of the triangles in the box tree: made once for a topology, the boxes are refitted every frame.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace penumbra {

enum class SpatialOrder { morton, kd };

// A complete tree of `arity` children per node and `arity` triangles per leaf; node n has the children
// n * arity + 1 ... n * arity + arity.
struct TriangleOrder {
  std::vector<uint32_t>
      slots;  // triangle of each slot, or no_triangle; leaf l has slots [l * arity, (l + 1) * arity)
  uint32_t tree_slots = 0;  // slots past it are triangles outside the tree, each on its own
  uint32_t leaf_count = 0;
  uint32_t first_leaf = 0;  // node number
  uint32_t node_count = 0;  // nodes to allocate: every child of an inner node exists
};

// Triangles whose extent is a large part of the scene's would blow up all boxes above them: at most
// `max_outside` of them stay outside the tree.
TriangleOrder order_triangles(const Geometry& geometry, uint32_t arity, SpatialOrder kind);

}  // namespace penumbra
