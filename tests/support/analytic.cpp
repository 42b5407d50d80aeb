#include "tests/support/analytic.h"

namespace penumbra::testing {
namespace {

// Of a polygon's points, dot(direction, x - center): > 0 in front of the light.
double height_over(const Light& light, Vec3d x) {
  return dot(Vec3d(light.direction), x - Vec3d(light.center));
}

// Clips by the planes through `apex` and the edges of `base`.
Polygon clip_to_pyramid(Polygon polygon, Vec3d apex, const Polygon& base) {
  Vec3d middle;
  for (const Vec3d& corner : base) middle += corner / static_cast<double>(base.size());
  for (std::size_t i = 0; i < base.size(); ++i) {
    Vec3d n = cross(base[i] - apex, base[(i + 1) % base.size()] - apex);
    if (dot(n, middle - apex) < 0) n = -n;
    polygon = clip(polygon, n, dot(n, apex));
  }
  return polygon;
}

// Where the rays from `eye` through the polygon's points reach the light's plane.
Polygon project(const Light& light, Vec3d eye, const Polygon& polygon) {
  Polygon projected;
  const double from = height_over(light, eye);
  for (const Vec3d& x : polygon)
    projected.push_back(eye + (x - eye) * (from / (from - height_over(light, x))));
  return projected;
}

}  // namespace

Polygon clip(const Polygon& polygon, Vec3d normal, double offset) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double da = dot(normal, a) - offset, db = dot(normal, b) - offset;
    if (da >= 0) inside.push_back(a);
    if ((da < 0) != (db < 0)) inside.push_back(a + (b - a) * (da / (da - db)));
  }
  return inside;
}

double area(const Polygon& polygon) {
  Vec3d twice;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return length(twice) / 2;
}

double rectangle_visibility(const Light& light, Vec3d position, Vec3d normal,
                            std::span<const Polygon> occluders) {
  const Vec3d center(light.center), u(light.edge_u), v(light.edge_v);
  const Polygon whole{center - u * 0.5 - v * 0.5, center + u * 0.5 - v * 0.5, center + u * 0.5 + v * 0.5,
                      center - u * 0.5 + v * 0.5};
  if (height_over(light, position) <= 0) return 0;
  const Polygon lit = clip(whole, normal, dot(normal, position));
  if (lit.size() < 3) return 0;
  double hidden = 0;
  for (const Polygon& occluder : occluders) {
    const Polygon between = clip(occluder, Vec3d(light.direction), dot(Vec3d(light.direction), center));
    hidden += area(project(light, position, clip_to_pyramid(between, position, lit)));
  }
  return (area(lit) - hidden) / area(whole);
}

std::vector<Polygon> faces_towards(Vec3d position, Vec3d lo, Vec3d hi) {
  std::vector<Polygon> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (const bool upper : {false, true}) {
      if (upper ? position[axis] <= hi[axis] : position[axis] >= lo[axis]) continue;
      Polygon face;
      for (const auto& [s, t] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        Vec3d corner;
        corner[axis] = upper ? hi[axis] : lo[axis];
        corner[a] = s ? hi[a] : lo[a];
        corner[b] = t ? hi[b] : lo[b];
        face.push_back(corner);
      }
      faces.push_back(face);
    }
  }
  return faces;
}

}  // namespace penumbra::testing
