#include "techniques/soft_shadow_volume/casters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace penumbra::soft_shadow_volume {
namespace {

// Disjoint sets of triangles.
class Surfaces {
 public:
  explicit Surfaces(std::size_t triangles) : parent_(triangles) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  uint32_t root(uint32_t t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }
  void join(uint32_t a, uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<uint32_t> parent_;
};

struct Plane {
  Vec3d normal, point;
  double height(Vec3f x) const { return dot(normal, Vec3d(x) - point); }
};

// The light's lowest height over the plane.
double lowest(const Light& light, const Plane& plane) {
  if (light.kind == LightKind::sphere) return plane.height(light.center) - double(light.radius);
  if (!light.is_area()) return plane.height(light.center);
  double least = INFINITY;
  for (const auto& [s, t] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}})
    least = std::min(least, plane.height(light.at(s, t)));
  return least;
}

// The plane of triangle t, its normal on the light's side; nothing when something is below it, so that a
// segment from there to the light might pass through the triangle.
std::optional<Plane> floor_plane(const Geometry& g, const Light& light, std::size_t t, double tolerance) {
  const Vec3d a(g.corner(t, 0)), b(g.corner(t, 1)), c(g.corner(t, 2));
  Plane plane{normalize(cross(b - a, c - a)), a};
  if (plane.height(light.center) < 0) plane.normal = -plane.normal;
  if (!(lowest(light, plane) > 0)) return {};
  for (const Vec3f& v : g.positions)
    if (plane.height(v) < -tolerance) return {};
  return plane;
}

bool lies_in(const Geometry& g, std::size_t t, const Plane& plane, double tolerance) {
  for (int i = 0; i < 3; ++i)
    if (std::abs(plane.height(g.corner(t, i))) > tolerance) return false;
  return true;
}

}  // namespace

Casters find_casters(const Geometry& g, const Adjacency& adjacency, const Light& light) {
  Surfaces surfaces(g.triangle_count());
  std::vector<uint8_t> open(g.triangle_count(), 0);
  std::vector<uint32_t> ragged;
  for (const Edge& e : adjacency.edges) {
    int sum = 0;
    for (uint32_t i = 0; i < e.face_count; ++i) {
      const EdgeFace& f = adjacency.faces[e.first_face + i];
      sum += f.sign;
      surfaces.join(adjacency.faces[e.first_face].triangle, f.triangle);
    }
    if (sum != 0) ragged.push_back(adjacency.faces[e.first_face].triangle);
  }
  for (const uint32_t t : ragged) open[surfaces.root(t)] = 1;

  Casters out;
  out.casts.assign(g.triangle_count(), 1);
  const double tolerance = 1e-6 * double(g.bounds.diagonal());
  std::optional<Plane> plane;
  for (uint32_t t = 0; t < g.triangle_count(); ++t) {
    if (!open[surfaces.root(t)]) continue;
    out.casts[t] = 0;
    if (plane && lies_in(g, t, *plane, tolerance)) continue;
    plane = floor_plane(g, light, t, tolerance);
    if (plane) continue;
    const Vec3f p = g.corner(t, 0);
    out.refusal = fmt::format(
        "Penumbra wedges need closed meshes, consistently wound. The surface at ({}, {}, {}) is open, and no "
        "flat floor under all that the light reaches.",
        p.x, p.y, p.z);
    return out;
  }
  return out;
}

}  // namespace penumbra::soft_shadow_volume
