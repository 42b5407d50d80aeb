// The shafts of a node, and which subnodes each of them meets: the same for all nodes, so made once.
//
// A side of a node is divided into N x N subsides. A shaft is the convex hull of two subsides on different
// sides: all segments from one to the other. 15 pairs of sides times N^4 shafts, as a shaft is its own
// inverse and none joins a side to itself [Keul2017, sec. 3].
#pragma once
#include <cstdint>
#include <vector>

namespace penumbra::line_space {

// Side 2 axis + (upper ? 1 : 0); a subside is v N + u, u and v its places along the other two axes in their
// order.
struct Shaft {
  uint32_t side[2], subside[2];
};

class ShaftTable {
 public:
  ShaftTable() = default;
  explicit ShaftTable(uint32_t branching);

  uint32_t branching() const { return n_; }
  uint32_t shafts() const { return 15 * n_ * n_ * n_ * n_; }
  // 32-bit words of one node's line space, a bit per shaft.
  uint32_t words() const { return (shafts() + 31) / 32; }
  // The shafts that meet subnode (z N + y) N + x, as such words.
  const uint32_t* row(uint32_t subnode) const { return rows_.data() + std::size_t{subnode} * words(); }
  const std::vector<uint32_t>& rows() const { return rows_; }

 private:
  uint32_t n_ = 0;
  std::vector<uint32_t> rows_;
};

// Place of a shaft's bit; the order of the two ends does not matter. The shaders' shaft_index().
uint32_t shaft_index(uint32_t branching, const Shaft& shaft);
Shaft shaft_at(uint32_t branching, uint32_t index);
// Whether the shaft and the subnode (x, y, z) have inner points in common, in integers, exactly.
bool meets(uint32_t branching, const Shaft& shaft, uint32_t x, uint32_t y, uint32_t z);

}  // namespace penumbra::line_space
