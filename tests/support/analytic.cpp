#include "tests/support/analytic.h"

#include <cmath>
#include <numbers>

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

// Signed area of the triangle (origin, a, b) within the unit circle about the origin.
double area_in_circle(Vec2d a, Vec2d b) {
  const auto sector = [](Vec2d p, Vec2d q) {
    return std::atan2(p.x * q.y - p.y * q.x, p.x * q.x + p.y * q.y) / 2;
  };
  const auto triangle = [](Vec2d p, Vec2d q) { return (p.x * q.y - p.y * q.x) / 2; };
  const Vec2d d{b.x - a.x, b.y - a.y};
  const double dd = d.x * d.x + d.y * d.y, ad = a.x * d.x + a.y * d.y, aa = a.x * a.x + a.y * a.y;
  const double root = ad * ad - dd * (aa - 1);
  if (!(dd > 0) || !(root > 0)) return sector(a, b);
  const double enter = (-ad - std::sqrt(root)) / dd, leave = (-ad + std::sqrt(root)) / dd;
  if (leave <= 0 || enter >= 1) return sector(a, b);
  const auto at = [&](double t) { return Vec2d{a.x + t * d.x, a.y + t * d.y}; };
  const Vec2d p = enter > 0 ? at(enter) : a, q = leave < 1 ? at(leave) : b;
  return (enter > 0 ? sector(a, p) : 0) + triangle(p, q) + (leave < 1 ? sector(q, b) : 0);
}

// Area of a polygon in the plane through `center`, spanned by the unit vectors u and v, within a circle.
double area_in_circle(const Polygon& polygon, Vec3d center, double radius, Vec3d u, Vec3d v) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d a = polygon[i] - center, b = polygon[(i + 1) % polygon.size()] - center;
    sum += area_in_circle({dot(a, u) / radius, dot(a, v) / radius}, {dot(b, u) / radius, dot(b, v) / radius});
  }
  return std::abs(sum) * radius * radius;
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

double disc_visibility(Vec3d center, double radius, Vec3d position, Vec3d normal,
                       std::span<const Polygon> occluders) {
  const Vec3d towards = normalize(position - center);
  const Vec3d any = std::abs(towards.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  const Vec3d u = normalize(cross(any, towards)), v = cross(towards, u);
  const auto square = [&](double half) {
    const Vec3d a = u * half, b = v * half;
    return Polygon{center - a - b, center + a - b, center + a + b, center - a + b};
  };
  const double offset = dot(normal, position), far = length(position - center);
  const double lit = area_in_circle(clip(square(2 * radius), normal, offset), center, radius, u, v);
  double hidden = 0;
  for (const Polygon& occluder : occluders) {
    Polygon seen =
        clip_to_pyramid(clip(occluder, towards, dot(towards, center)), position, square(2 * radius));
    for (Vec3d& x : seen) x = position + (x - position) * (far / (far - dot(towards, x - center)));
    hidden += area_in_circle(clip(seen, normal, offset), center, radius, u, v);
  }
  return (lit - hidden) / (std::numbers::pi * radius * radius);
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
