// The build on the host: the same steps as on the device, and the same predicate.
#include <atomic>
#include <bit>
#include <new>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "techniques/line_space/glsl.h"
#include "techniques/line_space/tree.h"

namespace penumbra::line_space {
namespace {

#include "techniques/line_space/shaders/overlap.glsl"

struct Pair {
  uint32_t triangle, node;  // the node's number in its level
};

class Builder {
 public:
  Builder(const Geometry& geometry, const Grid& grid, const ShaftTable& table, int limit_mib)
      : geometry_(geometry),
        table_(table),
        limit_mib_(limit_mib),
        n_(grid.branching),
        depth_(grid.depth),
        subnode_(grid.fine_cells()),
        lo_(grid.lo),
        scale_(grid.leaf_scale()),
        padding_(grid.padding()),
        occupancy_words_((n_ * n_ * n_ + 31) / 32) {}

  Pools build(const std::vector<uint32_t>& casters) {
    level_.push_back({0, 0, 0, 0});
    pairs_.reserve(casters.size());
    for (const uint32_t t : casters) pairs_.push_back({t, 0});
    for (uint32_t l = 0; l < depth_; ++l) {
      pools_.level_begin.push_back(static_cast<uint32_t>(pools_.nodes.size()));
      check_memory(n_, pools_.nodes.size() + level_.size(), pairs_.size(), limit_mib_);
      occupy();
      count_children();
      const bool last = l + 1 == depth_;
      append_level(last);
      if (!last) descend();
      subnode_ /= n_;
    }
    pools_.level_begin.push_back(static_cast<uint32_t>(pools_.nodes.size()));
    return std::move(pools_);
  }

 private:
  // Calls found(subnode) for every subnode of the pair's node that its triangle overlaps.
  template <class F>
  void for_overlaps(const Pair& pair, F&& found) const {
    const Node& node = level_[pair.node];
    const Vec3f lo{static_cast<float>(node.x), static_cast<float>(node.y), static_cast<float>(node.z)};
    const auto size = static_cast<float>(subnode_);
    const Vec3f half_size = Vec3f{0.5F * size, 0.5F * size, 0.5F * size} + padding_;
    const Corners t{to_leaves(geometry_.corner(pair.triangle, 0), lo_, scale_),
                    to_leaves(geometry_.corner(pair.triangle, 1), lo_, scale_),
                    to_leaves(geometry_.corner(pair.triangle, 2), lo_, scale_)};
    uint32_t first[3], last[3];
    for (int a = 0; a < 3; ++a) {
      first[a] = first_subnode(t.a[a], t.b[a], t.c[a], padding_[a], lo[a], size, n_);
      last[a] = last_subnode(t.a[a], t.b[a], t.c[a], padding_[a], lo[a], size, n_);
    }
    for (uint32_t z = first[2]; z <= last[2]; ++z)
      for (uint32_t y = first[1]; y <= last[1]; ++y)
        for (uint32_t x = first[0]; x <= last[0]; ++x) {
          const Vec3f middle{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F,
                             static_cast<float>(z) + 0.5F};
          if (overlaps(t, lo + middle * size, half_size)) found((z * n_ + y) * n_ + x);
        }
  }

  void occupy() {
    occupancy_.assign(level_.size() * occupancy_words_, 0);
    offsets_.assign(pairs_.size() + 1, 0);
    parallel_for(pairs_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for_overlaps(pairs_[i], [&](uint32_t subnode) {
          uint32_t& word = occupancy_[pairs_[i].node * std::size_t{occupancy_words_} + subnode / 32];
          std::atomic_ref<uint32_t>(word).fetch_or(1U << (subnode % 32), std::memory_order_relaxed);
          ++offsets_[i + 1];
        });
    });
  }

  void count_children() {
    first_child_.assign(level_.size() + 1, 0);
    for (std::size_t i = 0; i < occupancy_.size(); ++i)
      first_child_[i / occupancy_words_ + 1] += static_cast<uint64_t>(std::popcount(occupancy_[i]));
    std::partial_sum(first_child_.begin(), first_child_.end(), first_child_.begin());
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  }

  bool occupied(std::size_t node, uint32_t subnode) const {
    return occupancy_[node * occupancy_words_ + subnode / 32] >> (subnode % 32) & 1;
  }

  // Nodes, children groups and line spaces.
  void append_level(bool last) {
    const std::size_t base = pools_.nodes.size(), count = level_.size(), next = base + count;
    const std::size_t subnodes = std::size_t{n_} * n_ * n_, words = table_.words();
    pools_.nodes.resize(next);
    pools_.tree.resize(next * subnodes);
    pools_.line_space.resize(next * words, 0);
    parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        pools_.nodes[base + i] = level_[i];
        pools_.nodes[base + i].children = static_cast<uint32_t>((base + i) * subnodes);
        uint32_t* group = &pools_.tree[(base + i) * subnodes];
        uint32_t* shafts = &pools_.line_space[(base + i) * words];
        auto child = static_cast<uint32_t>(next + first_child_[i]);
        for (uint32_t s = 0; s < subnodes; ++s) {
          group[s] = empty_leaf;
          if (!occupied(i, s)) continue;
          group[s] = last ? occupied_leaf : child++;
          const uint32_t* row = table_.row(s);
          for (std::size_t w = 0; w < words; ++w) shafts[w] |= row[w];
        }
      }
    });
  }

  // To the next level: its nodes and its pairs.
  void descend() {
    check_memory(n_, pools_.nodes.size() + first_child_.back(), pairs_.size() + offsets_.back(), limit_mib_);
    std::vector<Pair> pairs(offsets_.back());
    parallel_for(pairs_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::size_t at = offsets_[i];
        for_overlaps(pairs_[i], [&](uint32_t subnode) {
          pairs[at++] = {pairs_[i].triangle, child(pairs_[i].node, subnode)};
        });
      }
    });
    std::vector<Node> level(first_child_.back());
    for (uint32_t i = 0; i < level_.size(); ++i)
      for (uint32_t s = 0, k = 0; s < n_ * n_ * n_; ++s)
        if (occupied(i, s))
          level[first_child_[i] + k++] = {0, level_[i].x + s % n_ * subnode_,
                                          level_[i].y + s / n_ % n_ * subnode_,
                                          level_[i].z + s / n_ / n_ * subnode_};
    pairs_ = std::move(pairs), level_ = std::move(level);
  }

  // Number in the next level.
  uint32_t child(uint32_t node, uint32_t subnode) const {
    const uint32_t* words = &occupancy_[node * std::size_t{occupancy_words_}];
    uint64_t number = first_child_[node];
    for (uint32_t w = 0; w < subnode / 32; ++w) number += static_cast<uint64_t>(std::popcount(words[w]));
    number += static_cast<uint64_t>(std::popcount(words[subnode / 32] & ((1U << (subnode % 32)) - 1)));
    return static_cast<uint32_t>(number);
  }

  const Geometry& geometry_;
  const ShaftTable& table_;
  int limit_mib_;
  uint32_t n_, depth_, subnode_;  // subnode_: leaves a side, of the present level's subnodes
  Vec3f lo_, scale_, padding_;
  uint32_t occupancy_words_;
  std::vector<Node> level_;
  std::vector<Pair> pairs_;
  std::vector<uint32_t> occupancy_;
  std::vector<uint64_t> offsets_, first_child_;
  Pools pools_;
};

}  // namespace

Pools build_tree(const Geometry& geometry, const std::vector<uint32_t>& casters, const Grid& grid,
                 const ShaftTable& table, int limit_mib) {
  try {
    return Builder(geometry, grid, table, limit_mib).build(casters);
  } catch (const std::bad_alloc&) {
    throw PointError("line_space: the host has not enough memory for the tree and its line spaces.");
  }
}

}  // namespace penumbra::line_space
