// What the vector code (compiled once per instruction set) and the plain code around it hand to one another.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "techniques/depth_complexity_sampling/light_space.h"
#include "techniques/depth_complexity_sampling/silhouettes.h"

namespace penumbra::depth_complexity {

// View samples go through the tree in groups: of `large` through the nodes, of `middle` through the blocks'
// edges, of `small` through the edges that are left.
inline constexpr std::size_t large_group = 256, middle_group = 64, small_group = 16;

// The origin of a view sample's shadow segments, in light space.
struct ViewPoint {
  float x, y, z;
  uint32_t pixel;
  bool across;  // the horizon may pass between the light's samples
};

// For each set of up to 8 lanes: the lanes in it, in order, and how many.
struct PackingEntry {
  uint8_t lane[8];
  uint8_t count;
};
inline constexpr std::array<PackingEntry, 256> packing_table = [] {
  std::array<PackingEntry, 256> table{};
  for (unsigned bits = 0; bits < 256; ++bits)
    for (uint8_t lane = 0; lane < 8; ++lane)
      if (bits >> lane & 1) table[bits].lane[table[bits].count++] = lane;
  return table;
}();

// Edges of a group, each field one array with room for 16 more than are used.
struct EdgeList {
  std::vector<float> v[fields];
  std::size_t count = 0;
  void reserve(std::size_t n) {
    if (v[0].size() < n + block_edges) grow_to(n + block_edges);
  }
  void grow_to(std::size_t n);
};

// The edges of one view sample that part light samples, as lines y = y0 + (x - x0) * slope over first <= x <
// last, clamped to [lo, hi]; weight: what a step downwards across it adds. Events: vertices above the first
// row.
enum CrossingField {
  cross_x0,
  cross_y0,
  cross_slope,
  cross_lo,
  cross_hi,
  cross_first,
  cross_last,
  cross_weight,
  event_x,
  event_weight,
  crossing_fields
};
struct Crossings {
  std::vector<float> v[crossing_fields];
  std::size_t count = 0, events = 0;
  // For n edges, each of which may leave an event at either end.
  void reserve(std::size_t n) {
    if (v[0].size() < 2 * n + block_edges) grow_to(2 * n + block_edges);
  }
  void grow_to(std::size_t n);
};

// Bits per view sample of a group, 1 = light sample of the least relative depth complexity. Of a grid: one
// word per row; of a set: 64 samples per word.
inline constexpr std::size_t most_words = 64, most_samples = most_words * 64;
struct Candidates {
  uint64_t words[small_group][most_words];
  bool parted[small_group];  // whether any edge parted the light's samples: else all are candidates
};

struct WorkCounts {
  uint64_t view_samples = 0, small_groups = 0, nodes = 0, blocks_tested = 0, blocks_entered = 0,
           edges_tested = 0, crossings = 0, unparted = 0, wide = 0, rays = 0, extra_rays = 0, traced = 0;
  void add(const WorkCounts& o);
};

// What one worker keeps between its groups and between frames.
struct alignas(64) Scratch {
  std::vector<uint32_t> stack, found;           // nodes to visit, blocks found
  std::vector<float> found_nodes[node_fields];  // their node fields, side by side
  EdgeList middle, small;
  Crossings crossings;
  // Counters, in the narrowest type that they fit; one row more than a grid can have.
  static constexpr std::size_t places = most_samples + 64;
  alignas(64) int8_t counters_8[places];
  alignas(64) int16_t counters_16[places];
  alignas(64) int32_t counters_32[places];
  alignas(64) std::byte sums[places * sizeof(int32_t)];  // what wide crossings add, in the counters' type
  std::vector<float> projected_x, projected_y;           // of a set's samples that are not in one plane
  Candidates candidates;
  WorkCounts counts;
  // Makes room for as much as another worker met.
  void grow_like(const Scratch& other);
  uint64_t bytes() const;
};

// Takes a small group's candidates.
class Judge {
 public:
  virtual ~Judge() = default;
  virtual void judge(const ViewPoint* points, std::size_t count, Scratch& scratch) const = 0;
};

// All that find_candidates() reads.
struct Occluders {
  const LightSpace* light;
  const Silhouettes* silhouettes;
  const Judge* judge;
};

// The candidates of up to `large_group` neighbouring view samples, with the best instruction set that the
// processor has. Small groups are consecutive runs of `small_group` points.
void find_candidates(const Occluders& scene, const ViewPoint* points, std::size_t count, Scratch& scratch);

// The instruction set and the number of float lanes that find_candidates() uses.
std::string instruction_set();
int vector_lanes();

}  // namespace penumbra::depth_complexity
