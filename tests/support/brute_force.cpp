#include "tests/support/brute_force.h"

#include <numbers>

#include "tests/support/triangle_tree.h"

namespace penumbra::testing {
namespace {

// Moves of a segment's two ends, tried in turn until the shortest that lets it escape is known.
class Escape {
 public:
  Escape(const Segment& segment, std::vector<Triangle> near, double search)
      : segment_(segment), near_(std::move(near)), search_(search) {}

  double shortest() {
    attempt({}, {});
    across_edges();
    around();
    return best_;
  }

 private:
  // The trim of the ends that frees the moved segment, added to the move itself.
  void attempt(Vec3d move_origin, Vec3d move_light) {
    const double move = std::max(length(move_origin), length(move_light));
    if (move > search_ || move >= best_) return;
    const Segment moved{segment_.origin + move_origin, segment_.along + move_light - move_origin};
    double trim = 0;
    for (const Triangle& triangle : near_)
      if (const auto t = meet(moved, triangle)) trim = std::max(trim, std::min(*t, 1 - *t) * moved.length());
    if (move + trim <= search_) best_ = std::min(best_, move + trim);
  }

  void attempt_all_ends(Vec3d move) {
    attempt(move, move);
    attempt(move, {});
    attempt({}, move);
  }

  // The way out of a union of triangles is over one of their edges: step just past each, on both sides.
  void across_edges() {
    const double past = 1e-3 * search_;
    for (const Triangle& triangle : near_)
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d a = triangle[i], b = triangle[(i + 1) % 3];
        const Vec3d to = to_edge(segment_, a, b);
        if (length(to) > search_) continue;
        const Vec3d across = normalize(cross(segment_.along, b - a));
        attempt(to + across * past, to + across * past);
        attempt(to - across * past, to - across * past);
      }
  }

  // Past a corner the way out may be in any direction.
  void around() {
    const Vec3d axis = normalize(segment_.along);
    const Vec3d any = std::abs(axis.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d u = normalize(cross(axis, any)), v = cross(axis, u);
    for (const double radius : {0.125, 0.25, 0.5, 0.75, 1.0})
      for (int k = 0; k < 24; ++k) {
        const double angle = 2 * std::numbers::pi * k / 24;
        attempt_all_ends((u * std::cos(angle) + v * std::sin(angle)) * (radius * search_ * (1 - 1e-9)));
      }
  }

  Segment segment_;
  std::vector<Triangle> near_;
  double search_, best_ = INFINITY;
};

}  // namespace

struct BruteForce::Impl {
  TriangleTree tree;
  // A direction without end becomes a segment that leaves the scene's bounds.
  Segment segment(Vec3d origin, Vec4d light_point) const {
    if (light_point.w != 0) return {origin, light_point.xyz() - origin};
    const double reach = 4 * tree.diagonal() + 4 * length(origin - tree.triangle(0)[0]);
    return {origin, normalize(light_point.xyz()) * reach};
  }
};

BruteForce::BruteForce(const Geometry& geometry) : impl_(new Impl{TriangleTree(geometry)}) {}
BruteForce::~BruteForce() = default;

bool BruteForce::blocked(Vec3d origin, Vec4d light_point, uint32_t skip) const {
  const Segment s = impl_->segment(origin, light_point);
  return impl_->tree.visit(s, 0, [&](uint32_t t) { return t != skip && meet(s, impl_->tree.triangle(t)); });
}

bool BruteForce::blocked_by_exhaustion(Vec3d origin, Vec4d light_point, uint32_t skip) const {
  const Segment s = impl_->segment(origin, light_point);
  for (uint32_t t = 0; t < impl_->tree.size(); ++t)
    if (t != skip && meet(s, impl_->tree.triangle(t))) return true;
  return false;
}

double BruteForce::tie_tolerance() const { return 4e-6 * impl_->tree.diagonal(); }

Tie BruteForce::explain(Vec3d origin, Vec4d light_point, uint32_t skip, double search) const {
  if (search <= 0) search = tie_tolerance();
  const Segment s = impl_->segment(origin, light_point);
  std::vector<Triangle> near;
  impl_->tree.visit(s, 1.01 * search, [&](uint32_t t) {
    if (t != skip) near.push_back(impl_->tree.triangle(t));
    return false;
  });
  Tie tie;
  double nearest = INFINITY;
  for (const Triangle& triangle : near) {
    tie.blocked = tie.blocked || meet(s, triangle);
    nearest = std::min(nearest, distance(s, triangle));
  }
  if (tie.blocked)
    tie.distance = Escape(s, std::move(near), search).shortest();
  else if (nearest <= search)
    tie.distance = nearest;
  return tie;
}

}  // namespace penumbra::testing
