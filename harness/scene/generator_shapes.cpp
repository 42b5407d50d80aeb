// Plain shapes, and the paper scenes made of them.
#include <cmath>
#include <numbers>

#include "scene/generator_table.h"
#include "scene/mesh_builder.h"
#include "scene/random.h"

namespace penumbra {
namespace {

using std::numbers::pi;

Mesh make_plane(const GeneratorValues& v) {
  Mesh m;
  const double sx = v.number("size_x"), sz = v.number("size_z");
  add_sheet(m, {-sx / 2, 0, -sz / 2}, {0, 0, sz}, {sx, 0, 0}, v.integer("rows"), v.integer("columns"));
  return m;
}

Mesh make_box(const GeneratorValues& v) {
  Mesh m;
  const Vec3d half{v.number("size_x") / 2, v.number("size_y") / 2, v.number("size_z") / 2};
  add_box(m, -half, half);
  return m;
}

Mesh make_sphere(const GeneratorValues& v) {
  Mesh m;
  const double r = v.number("radius");
  add_ellipsoid(m, {}, {r, r, r}, v.integer("columns"), v.integer("rows"));
  return m;
}

std::vector<Vec3d> circle(double radius, int segments) {
  std::vector<Vec3d> line;
  for (int i = 0; i < segments; ++i) {
    const double a = 2 * pi * i / segments;
    line.push_back({radius * std::cos(a), 0, radius * std::sin(a)});
  }
  return line;
}

Mesh make_torus(const GeneratorValues& v) {
  Mesh m;
  add_tube(m, circle(v.number("radius"), v.integer("segments")), v.number("tube_radius"), v.integer("sides"),
           TubeEnds::joined, {0, 1, 0});
  return m;
}

Mesh make_torus_knot(const GeneratorValues& v) {
  const int p = v.integer("p"), q = v.integer("q"), segments = v.integer("segments");
  const double radius = v.number("radius"), swing = radius / 2;
  std::vector<Vec3d> line;
  for (int i = 0; i < segments; ++i) {
    const double t = 2 * pi * i / segments;
    const double r = radius + swing * std::cos(q * t);
    line.push_back({r * std::cos(p * t), swing * std::sin(q * t), r * std::sin(p * t)});
  }
  Mesh m;
  add_tube(m, line, v.number("tube_radius"), v.integer("sides"), TubeEnds::joined);
  return m;
}

// A closed prism with fanned caps: 2 sides triangles of mantle, sides for each cap.
void add_column(Mesh& m, Vec3d foot, double radius, double height, int sides) {
  const auto n = static_cast<uint32_t>(sides);
  const auto rim = [&](int k) {
    const double a = 2 * pi * k / sides;
    return Vec3d{std::cos(a), 0, std::sin(a)};
  };
  const auto ring = [&](double y, bool mantle, Vec3d normal) {
    const auto base = static_cast<uint32_t>(m.positions.size());
    for (int k = 0; k < sides; ++k)
      add_vertex(m, foot + rim(k) * radius + Vec3d{0, y, 0}, mantle ? rim(k) : normal);
    return base;
  };
  const uint32_t low = ring(0, true, {}), high = ring(height, true, {});
  const uint32_t bottom = ring(0, false, {0, -1, 0}), top = ring(height, false, {0, 1, 0});
  const uint32_t bottom_center = add_vertex(m, foot, {0, -1, 0});
  const uint32_t top_center = add_vertex(m, foot + Vec3d{0, height, 0}, {0, 1, 0});
  for (uint32_t k = 0; k < n; ++k) {
    const uint32_t l = (k + 1) % n;
    add_triangle(m, low + k, high + k, high + l);
    add_triangle(m, low + k, high + l, low + l);
    add_triangle(m, bottom_center, bottom + k, bottom + l);
    add_triangle(m, top_center, top + l, top + k);
  }
}

Mesh make_columns(const GeneratorValues& v) {
  Mesh m;
  const int columns = v.integer("columns"), rows = v.integer("rows"), sides = v.integer("sides");
  const double spacing = v.number("spacing");
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      add_column(m, {(i - (columns - 1) / 2.0) * spacing, 0, (j - (rows - 1) / 2.0) * spacing},
                 v.number("radius"), v.number("height"), sides);
  const int fx = v.integer("floor_columns"), fz = v.integer("floor_rows");
  const double sx = (columns + 1) * spacing, sz = (rows + 1) * spacing;
  if (fx > 0 && fz > 0) add_sheet(m, {-sx / 2, 0, -sz / 2}, {0, 0, sz}, {sx, 0, 0}, fz, fx);
  return m;
}

Mesh make_city(const GeneratorValues& v) {
  Mesh m;
  Pcg32 random(static_cast<uint64_t>(v.integer("seed")));
  const int columns = v.integer("columns"), rows = v.integer("rows");
  const double spacing = v.number("spacing");
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double x = (i - (columns - 1) / 2.0) * spacing, z = (j - (rows - 1) / 2.0) * spacing;
      const double height = v.number("height") * (0.1 + 0.9 * std::pow(random.uniform(0, 1), 3));
      const double half = spacing * random.uniform(0.25, 0.4);
      add_box(m, {x - half, 0, z - half}, {x + half, height, z + half});
    }
  return m;
}

}  // namespace

std::vector<Generator> shape_generators() {
  return {
      {{"plane",
        "A rectangle in y = 0 that faces up.",
        "2 columns rows",
        {{"size_x", "extent along x", 10, 1e-6, 1e6, false},
         {"size_z", "extent along z", 10, 1e-6, 1e6, false},
         {"columns", "quads along x", 1, 1, 4096, true},
         {"rows", "quads along z", 1, 1, 4096, true}}},
       make_plane},
      {{"box",
        "A box about the origin.",
        "12",
        {{"size_x", "extent along x", 1, 1e-6, 1e6, false},
         {"size_y", "extent along y", 1, 1e-6, 1e6, false},
         {"size_z", "extent along z", 1, 1e-6, 1e6, false}}},
       make_box},
      {{"sphere",
        "A sphere about the origin, bands of latitude and longitude.",
        "2 columns (rows - 1)",
        {{"radius", "", 1, 1e-6, 1e6, false},
         {"columns", "divisions of the equator", 32, 3, 8192, true},
         {"rows", "bands from pole to pole", 16, 2, 8192, true}}},
       make_sphere},
      {{"torus",
        "A ring about the y axis.",
        "2 segments sides",
        {{"radius", "of the centre line", 1, 1e-6, 1e6, false},
         {"tube_radius", "", 0.25, 1e-6, 1e6, false},
         {"segments", "along the ring", 64, 3, 8192, true},
         {"sides", "around the tube", 32, 3, 8192, true}}},
       make_torus},
      {{"torus_knot",
        "A (p, q) torus knot about the y axis.",
        "2 segments sides",
        {{"p", "turns about the axis", 2, 1, 64, true},
         {"q", "turns about the tube's circle", 3, 1, 64, true},
         {"radius", "of the torus; the line swings by half of it", 1, 1e-6, 1e6, false},
         {"tube_radius", "", 0.25, 1e-6, 1e6, false},
         {"segments", "along the knot", 300, 3, 65536, true},
         {"sides", "around the tube", 20, 3, 8192, true}}},
       make_torus_knot},
      {{"columns",
        "Round columns in rows on a floor.",
        "4 sides columns rows + 2 floor_columns floor_rows",
        {{"columns", "along x", 5, 1, 512, true},
         {"rows", "along z", 2, 1, 512, true},
         {"sides", "of a column", 20, 3, 1024, true},
         {"radius", "", 0.25, 1e-6, 1e6, false},
         {"height", "", 3, 1e-6, 1e6, false},
         {"spacing", "between axes; the floor reaches one spacing past the outer ones", 1.5, 1e-6, 1e6,
          false},
         {"floor_columns", "quads along x; 0: no floor", 5, 0, 4096, true},
         {"floor_rows", "quads along z; 0: no floor", 4, 0, 4096, true}}},
       make_columns},
      {{"city",
        "Boxes of random height on a grid.",
        "12 columns rows",
        {{"columns", "along x", 20, 1, 1024, true},
         {"rows", "along z", 20, 1, 1024, true},
         {"spacing", "between centres", 0.16, 1e-6, 1e6, false},
         {"height", "of the tallest", 1, 1e-6, 1e6, false},
         {"seed", "", 1, 0, 4294967295.0, true}}},
       make_city},
  };
}

}  // namespace penumbra
