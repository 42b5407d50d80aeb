// Per frame: the edges that can be silhouettes between the light and a point before it, in blocks, and a tree
// of boxes over the blocks.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "techniques/depth_complexity_sampling/light_space.h"
#include "techniques/depth_complexity_sampling/topology.h"

namespace penumbra::depth_complexity {

inline constexpr std::size_t block_edges = 16;  // also the tree's branching

// Fields of a block, each of 16 floats: ends A and B (first face: A to B), the planes n.x * x + n.y * y + n.z
// * z - d of both faces; flip: the sign bit where the second face is flipped; weight: faces of this record, 1
// or 2.
enum Field { ax, ay, az, bx, by, bz, n1x, n1y, n1z, d1, n2x, n2y, n2z, d2, flip, weight, fields };
struct alignas(64) Block {
  float v[fields][block_edges];
};

// Fields of a tree node: its box; the box of its faces' normals (those of second faces turned so that an edge
// whose two normals see a point from the same side is no silhouette there) by centre and radius; the planes'
// offsets, relative to the box's centre, by centre and radius.
enum NodeField {
  lo_x,
  lo_y,
  lo_z,
  hi_x,
  hi_y,
  hi_z,
  normal_x,
  normal_y,
  normal_z,
  spread_x,
  spread_y,
  spread_z,
  offset,
  offset_spread,
  node_fields
};
struct NodeLevel {
  std::size_t count = 0;
  std::array<std::vector<float>, node_fields> v;  // padded to a multiple of 16 with empty boxes
  void resize(std::size_t n);
};

class Silhouettes {
 public:
  void move_vertices(const EdgeTopology& t, const std::vector<Vec3f>& positions, const LightSpace& light);
  void find_planes(const EdgeTopology& t, const LightSpace& light);
  void choose_edges(const EdgeTopology& t);
  void fill_blocks(const EdgeTopology& t, const LightSpace& light);
  void build_tree(const LightSpace& light);

  const std::vector<Block>& blocks() const { return blocks_; }
  std::size_t block_count() const { return levels_.front().count; }
  // levels()[0] are the blocks; the last one has at most 16 nodes.
  const std::vector<NodeLevel>& levels() const { return levels_; }
  std::size_t level_count() const { return level_count_; }
  std::size_t potential() const { return potential_; }
  uint64_t bytes() const;

 private:
  struct Plane {
    float x, y, z, d;
  };
  // Where a straddling face meets the plane of the light, as the face runs.
  struct Cut {
    uint32_t face, leaves_a, leaves_b, enters_a, enters_b;
  };
  struct Ends {
    Vec3f a, b;
  };
  void find_cuts(const EdgeTopology& t);
  Vec3f on_light_plane(uint32_t a, uint32_t b) const;
  Ends ends(const EdgeTopology& t, std::size_t potential) const;
  void fill_block(const EdgeTopology& t, std::size_t block, float pad);

  std::vector<Vec3f> positions_;  // of welded vertices, light space
  std::vector<Plane> planes_;     // of faces
  std::vector<int8_t>
      side_;  // of a face: where it sees the whole light, +1 or -1; 0: across, or too near to say
  std::vector<uint32_t> chosen_;  // edges, in the order of the topology
  std::vector<uint32_t> chunk_;   // scratch: entries per chunk
  std::vector<Cut> cuts_;
  bool behind_ = false;  // some vertex lies behind the light's plane, or in it
  std::size_t potential_ = 0;
  std::vector<Block> blocks_;
  std::vector<NodeLevel> levels_{1};
  std::size_t level_count_ = 1;
};

}  // namespace penumbra::depth_complexity
