#include "scene/mesh_builder.h"

#include <cmath>
#include <numbers>

namespace penumbra {

using std::numbers::pi;

uint32_t add_vertex(Mesh& out, Vec3d position, Vec3d unit_normal) {
  out.positions.push_back(Vec3f(position));
  out.normals.push_back(Vec3f(unit_normal));
  return static_cast<uint32_t>(out.positions.size() - 1);
}

void add_triangle(Mesh& out, uint32_t a, uint32_t b, uint32_t c) {
  out.indices.push_back(a);
  out.indices.push_back(b);
  out.indices.push_back(c);
}

void add_sheet(Mesh& out, Vec3d corner, Vec3d u, Vec3d v, int columns, int rows) {
  const Vec3d normal = normalize(cross(u, v));
  const auto base = static_cast<uint32_t>(out.positions.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      add_vertex(out, corner + u * (double(i) / columns) + v * (double(j) / rows), normal);
  const auto stride = static_cast<uint32_t>(columns + 1);
  for (uint32_t j = 0; j < static_cast<uint32_t>(rows); ++j)
    for (uint32_t i = 0; i < static_cast<uint32_t>(columns); ++i) {
      const uint32_t a = base + j * stride + i, d = a + stride;
      add_triangle(out, a, a + 1, d + 1);
      add_triangle(out, a, d + 1, d);
    }
}

void add_box(Mesh& out, Vec3d lo, Vec3d hi) {
  // Corners are taken from lo and hi themselves, so that faces meet in equal floats.
  const auto face = [&](Vec3d a, Vec3d b, Vec3d c, Vec3d d, Vec3d normal) {
    const uint32_t v = add_vertex(out, a, normal);
    add_vertex(out, b, normal), add_vertex(out, c, normal), add_vertex(out, d, normal);
    add_triangle(out, v, v + 1, v + 2);
    add_triangle(out, v, v + 2, v + 3);
  };
  const auto corner = [&](int i) {
    return Vec3d{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z};
  };
  face(corner(2), corner(3), corner(1), corner(0), {0, 0, -1});
  face(corner(5), corner(7), corner(6), corner(4), {0, 0, 1});
  face(corner(1), corner(5), corner(4), corner(0), {0, -1, 0});
  face(corner(6), corner(7), corner(3), corner(2), {0, 1, 0});
  face(corner(4), corner(6), corner(2), corner(0), {-1, 0, 0});
  face(corner(3), corner(7), corner(5), corner(1), {1, 0, 0});
}

void add_ellipsoid(Mesh& out, Vec3d center, Vec3d radii, int columns, int rows) {
  const auto add = [&](Vec3d unit) {
    const Vec3d normal = normalize(Vec3d{unit.x / radii.x, unit.y / radii.y, unit.z / radii.z});
    return add_vertex(out, center + Vec3d{unit.x * radii.x, unit.y * radii.y, unit.z * radii.z}, normal);
  };
  const uint32_t south = add({0, -1, 0});
  const auto n = static_cast<uint32_t>(columns);
  for (int r = 1; r < rows; ++r) {
    const double latitude = pi * (double(r) / rows - 0.5);
    for (int c = 0; c < columns; ++c) {
      const double longitude = 2 * pi * c / columns;
      add({std::cos(latitude) * std::cos(longitude), std::sin(latitude),
           std::cos(latitude) * std::sin(longitude)});
    }
  }
  const uint32_t north = add({0, 1, 0});
  const uint32_t last_ring = north - n;
  for (uint32_t c = 0; c < n; ++c) {
    const uint32_t next = (c + 1) % n;
    add_triangle(out, south, south + 1 + c, south + 1 + next);
    for (uint32_t ring = south + 1; ring < last_ring; ring += n) {
      add_triangle(out, ring + c, ring + n + c, ring + n + next);
      add_triangle(out, ring + c, ring + n + next, ring + next);
    }
    add_triangle(out, last_ring + c, north, last_ring + next);
  }
}

namespace {

Vec3d tangent(const std::vector<Vec3d>& line, std::size_t i, bool joined) {
  const std::size_t n = line.size();
  if (joined) return normalize(line[(i + 1) % n] - line[(i + n - 1) % n]);
  return normalize(line[std::min(i + 1, n - 1)] - line[i > 0 ? i - 1 : 0]);
}

void add_caps(Mesh& out, uint32_t first, uint32_t last, uint32_t sides) {
  for (uint32_t k = 1; k + 1 < sides; ++k) {
    add_triangle(out, first, first + k + 1, first + k);
    add_triangle(out, last, last + k, last + k + 1);
  }
}

}  // namespace

void add_tube(Mesh& out, const std::vector<Vec3d>& line, double radius, int sides, TubeEnds ends, Vec3d up) {
  const auto base = static_cast<uint32_t>(out.positions.size());
  const bool joined = ends == TubeEnds::joined;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3d t = tangent(line, i, joined);
    Vec3d a = up - t * dot(up, t);
    if (dot(a, a) < 1e-6) a = Vec3d{1, 0, 0} - t * t.x;
    a = up = normalize(a);
    const Vec3d b = cross(t, a);
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * pi * k / sides;
      const double c = std::cos(angle), s = std::sin(angle);
      add_vertex(out, line[i] + a * (radius * c) + b * (radius * s), a * c + b * s);
    }
  }
  const auto n = static_cast<uint32_t>(sides);
  const auto rings = static_cast<uint32_t>(line.size());
  for (uint32_t i = 0; i < (joined ? rings : rings - 1); ++i)
    for (uint32_t k = 0; k < n; ++k) {
      const uint32_t a = base + i * n + k, b = base + i * n + (k + 1) % n;
      const uint32_t c = base + (i + 1) % rings * n + k, d = base + (i + 1) % rings * n + (k + 1) % n;
      add_triangle(out, a, b, c);
      add_triangle(out, b, d, c);
    }
  if (ends == TubeEnds::capped) add_caps(out, base, base + (rings - 1) * n, n);
}

}  // namespace penumbra
