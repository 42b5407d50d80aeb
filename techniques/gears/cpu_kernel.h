// backend: cpu. What the vector code (compiled once per instruction set) and the plain code around it hand to
// one another.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"

namespace penumbra::gears::cpu {

inline constexpr std::size_t block_size = 16;  // triangles in a block, children of a tree's node
inline constexpr std::size_t most_rows = 64, most_words = 128;

// Triangles side by side, in working space (see FrameConstants). Absent ones have all corners at `nowhere`,
// from where they hide nothing.
enum Corner { ax, ay, az, bx, by, bz, cx, cy, cz, corner_fields };
struct alignas(64) Block {
  float v[corner_fields][block_size];
};
inline constexpr Vec3f nowhere{0, 0, 1e30F};

enum BoxField { lo_x, lo_y, lo_z, hi_x, hi_y, hi_z, box_fields };
// Boxes side by side, field by field, with room for a block's worth more than are used.
using Boxes = std::array<std::vector<float>, box_fields>;

// P' of a view sample, in working space.
struct ViewPoint {
  float x, y, z;
  uint32_t pixel;
};

// The light's samples as a mask sees them.
struct LightView {
  bool grid = false;      // sample (column c, row r) at (c, r, 0); else a set
  bool infinite = false;  // a set of directions
  int columns = 1, rows = 1;
  std::size_t parts = 1;  // 32-bit words to a row of a grid
  std::size_t samples = 1;
  float pad = 0;               // bound of a coordinate's rounding error
  Vec3f lo, hi;                // of a set: the samples' bounds, or those of the directions
  std::vector<float> x, y, z;  // of a set, padded to a multiple of 32 by repeating the last one
  std::size_t words() const { return x.size() / 32; }
};

struct WorkCounts {
  uint64_t view_samples = 0, groups = 0, nodes = 0, blocks_found = 0, blocks_entered = 0, pairs = 0,
           listed = 0;
  void add(const WorkCounts& o);
};

// What one worker keeps between its groups and between frames.
struct alignas(64) Scratch {
  // 1 = blocked, or no light sample. A grid: part q of row r is word q * most_rows + r. A set: bit by bit.
  alignas(64) uint32_t mask[most_words];
  std::vector<ViewPoint> points;         // while they are put into groups
  std::vector<uint32_t> stack, found;    // nodes to visit; blocks that may matter to the group
  Boxes found_boxes;                     // theirs
  std::vector<uint32_t> sizes, ordered;  // while they are ordered
  std::vector<Block> listed;             // triangles of the list that may matter to the group
  std::size_t listed_count = 0;          // triangles
  std::vector<Block> cell;               // assignment: triangles: those of the cell
  std::vector<float> to_x, to_y, to_z;   // of a set: light samples relative to P'
  WorkCounts counts;
  void grow_like(const Scratch& other);
  uint64_t bytes() const;
};

// Begins and ends a view sample's mask.
class Masks {
 public:
  virtual ~Masks() = default;
  // The light samples below the horizon, and those that do not exist. False: nothing else to be seen.
  virtual bool begin(uint32_t pixel, uint32_t* mask) const = 0;
  virtual void write(uint32_t pixel, const uint32_t* mask) const = 0;
};

// All that the kernels read.
struct Occluders {
  const LightView* light;
  const Masks* masks;
  const Boxes* boxes;   // of the tree's nodes: node n has the children 16 n + 1 ... 16 n + 16
  const Block* blocks;  // of leaves
  uint32_t first_leaf;  // node number
  const Block* listed;  // triangles outside the tree or the grid
  std::size_t listed_count;
};

// assignment: clusters. The masks of neighbouring view samples.
void walk_tree(const Occluders& scene, const ViewPoint* points, std::size_t count, Scratch& scratch);
// assignment: triangles. Those of a cell: `triangles` in scratch.cell.
void walk_cell(const Occluders& scene, std::size_t triangles, const ViewPoint* points, std::size_t count,
               Scratch& scratch);

// The instruction set in use, and floats in its vectors.
std::string instruction_set();
int vector_lanes();

}  // namespace penumbra::gears::cpu
