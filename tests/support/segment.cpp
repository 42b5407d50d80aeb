#include "tests/support/segment.h"

namespace penumbra::testing {
namespace {

double determinant(Vec3d a, Vec3d b, Vec3d c) { return dot(a, cross(b, c)); }

// Distance of a point to the triangle when it projects into its inside, else infinity (an edge is nearer
// then).
double distance_over_face(Vec3d p, const Triangle& t) {
  const Vec3d n = cross(t[1] - t[0], t[2] - t[0]);
  const double area = length(n);
  if (area == 0) return INFINITY;
  for (std::size_t i = 0; i < 3; ++i)
    if (determinant(n, t[(i + 1) % 3] - t[i], p - t[i]) < 0) return INFINITY;
  return std::abs(dot(n, p - t[0])) / area;
}

}  // namespace

std::optional<double> meet(const Segment& s, const Triangle& triangle) {
  const Vec3d a = triangle[0] - s.origin, b = triangle[1] - s.origin, c = triangle[2] - s.origin;
  const double u = determinant(s.along, c, b), v = determinant(s.along, a, c), w = determinant(s.along, b, a);
  const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  if (!inside || u + v + w == 0) return std::nullopt;
  const Vec3d n = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const double slope = dot(n, s.along);
  if (slope == 0) return std::nullopt;
  const double t = dot(n, a) / slope;
  if (!(t > 0 && t < 1)) return std::nullopt;
  return t;
}

Vec3d to_edge(const Segment& s, Vec3d a, Vec3d b) {
  // Minimises |s.at(x) - (a + y (b - a))|; clamps x, then y, then x again, which is exact for two segments.
  const Vec3d d = s.along, e = b - a, r = s.origin - a;
  const double dd = dot(d, d), ee = dot(e, e), de = dot(d, e), dr = dot(d, r), er = dot(e, r);
  const double denominator = dd * ee - de * de;
  double x = denominator > 0 ? std::clamp((de * er - dr * ee) / denominator, 0.0, 1.0) : 0.0;
  const double y = ee > 0 ? std::clamp((de * x + er) / ee, 0.0, 1.0) : 0.0;
  x = dd > 0 ? std::clamp((de * y - dr) / dd, 0.0, 1.0) : 0.0;
  return a + e * y - s.at(x);
}

double distance(const Segment& s, const Triangle& t) {
  if (meet(s, t)) return 0;
  double d = std::min(distance_over_face(s.origin, t), distance_over_face(s.at(1), t));
  for (std::size_t i = 0; i < 3; ++i) d = std::min(d, length(to_edge(s, t[i], t[(i + 1) % 3])));
  return d;
}

}  // namespace penumbra::testing
