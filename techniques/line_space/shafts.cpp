#include "techniques/line_space/shafts.h"

#include "core/parallel.h"

namespace penumbra::line_space {
namespace {

// What a subside covers of each axis, in subnodes.
struct Extent {
  int lo[3], hi[3];
};

Extent extent_of(uint32_t n, uint32_t side, uint32_t subside) {
  Extent e{};
  const uint32_t axis = side / 2, place[2] = {subside % n, subside / n};
  for (uint32_t a = 0, k = 0; a < 3; ++a) {
    e.lo[a] = static_cast<int>(a == axis ? (side % 2) * n : place[k]);
    e.hi[a] = e.lo[a] + (a == axis ? 0 : 1);
    k += a == axis ? 0 : 1;
  }
  return e;
}

// The s in (0, 1) that satisfy inequalities alpha + beta s > 0, as an open interval of fractions.
class Interval {
 public:
  bool empty() const { return lo_ * hi_over_ >= hi_ * lo_over_; }
  void require_positive(int alpha, int beta) {
    if (beta == 0 && alpha <= 0) hi_ = lo_ = 0;
    if (beta > 0 && -alpha * lo_over_ > lo_ * beta) lo_ = -alpha, lo_over_ = beta;
    if (beta < 0 && alpha * hi_over_ < hi_ * -beta) hi_ = alpha, hi_over_ = -beta;
  }

 private:
  int lo_ = 0, lo_over_ = 1, hi_ = 1, hi_over_ = 1;
};

// The hull of two boxes is the union of (1 - s) A + s B, and each of these is a box whose ends are linear in
// s: it has inner points in common with the subnode where six inequalities hold.
bool hull_meets(const Extent& a, const Extent& b, const int (&subnode)[3]) {
  Interval s;
  for (int axis = 0; axis < 3; ++axis) {
    s.require_positive(subnode[axis] + 1 - a.lo[axis], a.lo[axis] - b.lo[axis]);
    s.require_positive(a.hi[axis] - subnode[axis], b.hi[axis] - a.hi[axis]);
  }
  return !s.empty();
}

}  // namespace

uint32_t shaft_index(uint32_t n, const Shaft& shaft) {
  const int first = shaft.side[0] < shaft.side[1] ? 0 : 1;
  const uint32_t a = shaft.side[first], b = shaft.side[1 - first];
  const uint32_t pair = a * (11 - a) / 2 + b - a - 1;
  return (pair * n * n + shaft.subside[first]) * n * n + shaft.subside[1 - first];
}

Shaft shaft_at(uint32_t n, uint32_t index) {
  Shaft s{};
  s.subside[1] = index % (n * n);
  s.subside[0] = index / (n * n) % (n * n);
  uint32_t pair = index / (n * n * n * n);
  while (pair >= 5 - s.side[0]) pair -= 5 - s.side[0]++;
  s.side[1] = s.side[0] + 1 + pair;
  return s;
}

bool meets(uint32_t n, const Shaft& shaft, uint32_t x, uint32_t y, uint32_t z) {
  const int subnode[3] = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
  return hull_meets(extent_of(n, shaft.side[0], shaft.subside[0]),
                    extent_of(n, shaft.side[1], shaft.subside[1]), subnode);
}

ShaftTable::ShaftTable(uint32_t branching) : n_(branching) {
  const std::size_t subnodes = std::size_t{n_} * n_ * n_;
  rows_.assign(subnodes * words(), 0);
  std::vector<Extent> ends(2 * std::size_t{shafts()});
  for (uint32_t i = 0; i < shafts(); ++i) {
    const Shaft s = shaft_at(n_, i);
    for (std::size_t k = 0; k < 2; ++k) ends[2 * i + k] = extent_of(n_, s.side[k], s.subside[k]);
  }
  parallel_for(subnodes, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const int subnode[3] = {static_cast<int>(c % n_), static_cast<int>(c / n_ % n_),
                              static_cast<int>(c / n_ / n_)};
      uint32_t* row = rows_.data() + c * words();
      for (uint32_t i = 0; i < shafts(); ++i)
        if (hull_meets(ends[2 * i], ends[2 * i + 1], subnode)) row[i / 32] |= 1U << (i % 32);
    }
  });
}

}  // namespace penumbra::line_space
