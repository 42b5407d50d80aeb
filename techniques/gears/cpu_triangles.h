// backend: cpu. The triangles in working space, every frame: blocks and a tree of boxes over them
// (assignment: clusters), or as they are (assignment: triangles), and the list of those that neither the tree
// nor the grid can hold.
#pragma once
#include <atomic>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "techniques/common/triangle_order.h"
#include "techniques/gears/cpu_grid.h"
#include "techniques/gears/cpu_kernel.h"
#include "techniques/gears/shaders/shared.h"

namespace penumbra::gears::cpu {

class Triangles {
 public:
  // Once per topology. `tree`: order for assignment: clusters.
  void order(const Geometry& geometry, bool tree, SpatialOrder kind);
  // Per frame.
  void move_vertices(const Geometry& geometry, const FrameConstants& f);
  void fill_blocks(const Geometry& geometry);                                            // tree
  void refit();                                                                          // tree
  void find_cells(const Geometry& geometry, const FrameConstants& f, const Grid& grid);  // no tree

  const Boxes& boxes() const { return boxes_; }
  const std::vector<Block>& blocks() const { return blocks_; }
  uint32_t first_leaf() const { return order_.first_leaf; }
  uint32_t leaf_count() const { return order_.leaf_count; }
  uint32_t node_count() const { return order_.node_count; }
  const std::vector<Block>& listed() const { return list_blocks_; }
  std::size_t listed_count() const { return listed_.size(); }
  // Of each triangle; one in the list has none (x0 > x1).
  const std::vector<CellRange>& cells() const { return cells_; }
  Vec3f working(uint32_t vertex) const { return working_[vertex]; }
  uint64_t bytes() const;

 private:
  void corners(const Geometry& g, uint32_t triangle, Vec3f* out) const {
    for (std::size_t k = 0; k < 3; ++k) out[k] = working_[g.indices[3 * std::size_t{triangle} + k]];
  }
  void add_to_list(uint32_t triangle) { list_slots_[list_used_.fetch_add(1)] = triangle; }
  void fill_list(const Geometry& geometry);
  void fill_leaf(const Geometry& geometry, std::size_t leaf);

  bool grid_ = false;  // the light's samples are a grid: what lies behind them is none of ours
  std::vector<Vec3f> working_;
  TriangleOrder order_;
  std::vector<Block> blocks_;
  Boxes boxes_;
  std::vector<CellRange> cells_;
  std::vector<uint32_t> list_slots_, listed_;
  std::atomic<uint32_t> list_used_{0};
  std::vector<Block> list_blocks_;
};

// Writes a triangle into a block; `corners` null: an absent one.
void put(Block& block, std::size_t lane, const Vec3f* corners);

}  // namespace penumbra::gears::cpu
