// A plain box tree over triangles in double precision: finds the triangles near a segment.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "tests/support/segment.h"

namespace penumbra::testing {

class TriangleTree {
 public:
  explicit TriangleTree(const Geometry& geometry);
  std::size_t size() const { return triangles_.size(); }
  const Triangle& triangle(uint32_t t) const { return triangles_[t]; }
  double diagonal() const { return diagonal_; }

  // The first triangle along the segment, and its t as a share of the segment's length.
  struct Hit {
    uint32_t triangle;  // no_triangle: none
    double t;
  };
  Hit nearest(const Segment& ray) const;

  // Calls visit(triangle index) for every triangle whose box comes within `radius` of the segment's points
  // (some more may be visited); stops when it returns true. Returns whether it was stopped.
  template <class F>
  bool visit(const Segment& s, double radius, F&& visit) const {
    std::vector<uint32_t> stack{0};
    while (!stack.empty()) {
      const Node& node = nodes_[stack.back()];
      stack.pop_back();
      if (!near_box(s, node, radius)) continue;
      if (node.count == 0) {
        stack.push_back(node.first);
        stack.push_back(node.first + 1);
        continue;
      }
      for (uint32_t i = node.first; i < node.first + node.count; ++i)
        if (visit(order_[i])) return true;
    }
    return false;
  }

 private:
  struct Node {
    Vec3d lo, hi;
    uint32_t first = 0, count = 0;  // count 0: children first and first + 1; else triangles of order_
  };
  static bool near_box(const Segment& s, const Node& node, double radius);
  void split(uint32_t node, uint32_t begin, uint32_t end);

  std::vector<Triangle> triangles_;
  std::vector<Vec3d> centers_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
  double diagonal_ = 0;
};

}  // namespace penumbra::testing
