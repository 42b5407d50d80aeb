#include "tests/support/triangle_tree.h"

#include <algorithm>
#include <numeric>

#include "samples/view_samples.h"

namespace penumbra::testing {

TriangleTree::TriangleTree(const Geometry& geometry) {
  const std::size_t count = geometry.triangle_count();
  Box bounds;
  for (const Vec3f& p : geometry.positions) bounds.extend(p);
  diagonal_ = bounds.empty() ? 0 : length(Vec3d(bounds.hi) - Vec3d(bounds.lo));
  for (std::size_t t = 0; t < count; ++t) {
    triangles_.push_back(
        {Vec3d(geometry.corner(t, 0)), Vec3d(geometry.corner(t, 1)), Vec3d(geometry.corner(t, 2))});
    const Triangle& tri = triangles_.back();
    centers_.push_back((min(min(tri[0], tri[1]), tri[2]) + max(max(tri[0], tri[1]), tri[2])) * 0.5);
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(2 * count + 1);
  nodes_.emplace_back();
  split(0, 0, static_cast<uint32_t>(count));
}

void TriangleTree::split(uint32_t node, uint32_t begin, uint32_t end) {
  Vec3d lo{INFINITY, INFINITY, INFINITY}, hi = -lo, center_lo = lo, center_hi = hi;
  for (uint32_t i = begin; i < end; ++i) {
    for (const Vec3d& corner : triangles_[order_[i]]) lo = min(lo, corner), hi = max(hi, corner);
    center_lo = min(center_lo, centers_[order_[i]]), center_hi = max(center_hi, centers_[order_[i]]);
  }
  nodes_[node].lo = lo, nodes_[node].hi = hi;
  if (end - begin <= 4) {
    nodes_[node].first = begin, nodes_[node].count = end - begin;
    return;
  }
  const Vec3d extent = center_hi - center_lo;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](uint32_t a, uint32_t b) { return centers_[a][axis] < centers_[b][axis]; });
  const uint32_t child = static_cast<uint32_t>(nodes_.size());
  nodes_[node].first = child;
  nodes_.resize(nodes_.size() + 2);
  split(child, begin, middle);
  split(child + 1, middle, end);
}

TriangleTree::Hit TriangleTree::nearest(const Segment& ray) const {
  Hit best{no_triangle, INFINITY};
  visit(ray, 0, [&](uint32_t t) {
    if (const auto at = meet(ray, triangles_[t]); at && *at < best.t) best = {t, *at};
    return false;
  });
  return best;
}

bool TriangleTree::near_box(const Segment& s, const Node& node, double radius) {
  double enter = 0, leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    // A little wider than asked, so that rounding in the division never loses a triangle.
    const double pad = radius + 1e-12 * (1 + std::abs(node.lo[axis]) + std::abs(node.hi[axis]));
    const double lo = node.lo[axis] - pad - s.origin[axis], hi = node.hi[axis] + pad - s.origin[axis];
    const double d = s.along[axis];
    if (d == 0) {
      if (lo > 0 || hi < 0) return false;
      continue;
    }
    enter = std::max(enter, std::min(lo / d, hi / d));
    leave = std::min(leave, std::max(lo / d, hi / d));
  }
  return enter <= leave + 1e-12;
}

}  // namespace penumbra::testing
