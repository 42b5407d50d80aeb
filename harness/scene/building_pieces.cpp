#include "scene/building_pieces.h"

#include <cmath>
#include <numbers>

#include "scene/mesh_builder.h"

namespace penumbra {

using std::numbers::pi;

namespace {

constexpr Vec3d up{0, 1, 0};

Vec3d on_circle(double radius, double height, int k, int sides) {
  const double a = 2 * pi * k / sides;
  return {radius * std::cos(a), height, radius * std::sin(a)};
}

// The disc that ends a lathe's profile.
void add_disc(Mesh& out, Vec3d foot, ProfilePoint at, int sides, bool faces_up) {
  const Vec3d normal = faces_up ? up : -up;
  const uint32_t center = add_vertex(out, foot + up * at.height, normal);
  for (int k = 0; k < sides; ++k) add_vertex(out, foot + on_circle(at.radius, at.height, k, sides), normal);
  for (uint32_t k = 0; k < static_cast<uint32_t>(sides); ++k) {
    const uint32_t here = center + 1 + k, next = center + 1 + (k + 1) % static_cast<uint32_t>(sides);
    if (faces_up)
      add_triangle(out, center, next, here);
    else
      add_triangle(out, center, here, next);
  }
}

// One sheet of a slab with normals averaged over its own triangles.
void add_sheet_of(Mesh& out, int columns, int rows, const SheetPoint& point,
                  const std::function<bool(int, int)>& turned, bool reversed) {
  const auto base = static_cast<uint32_t>(out.positions.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) add_vertex(out, point(i, j), {});
  const std::size_t first_index = out.indices.size();
  const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    reversed ? add_triangle(out, a, c, b) : add_triangle(out, a, b, c);
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const uint32_t a = base + static_cast<uint32_t>(j * (columns + 1) + i), b = a + 1;
      const uint32_t d = a + static_cast<uint32_t>(columns + 1), c = d + 1;
      if (turned && turned(i, j))
        triangle(a, b, d), triangle(b, c, d);
      else
        triangle(a, b, c), triangle(a, c, d);
    }
  std::vector<Vec3d> sums(out.positions.size() - base);
  for (std::size_t t = first_index; t < out.indices.size(); t += 3) {
    const Vec3d a(out.positions[out.indices[t]]), b(out.positions[out.indices[t + 1]]),
        c(out.positions[out.indices[t + 2]]);
    for (std::size_t k = 0; k < 3; ++k) sums[out.indices[t + k] - base] += normalize(cross(b - a, c - a));
  }
  for (std::size_t v = 0; v < sums.size(); ++v) out.normals[base + v] = Vec3f(normalize(sums[v]));
}

void add_flat_quad(Mesh& out, Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  const Vec3d normal = normalize(cross(c - a, d - b));
  const uint32_t v = add_vertex(out, a, normal);
  add_vertex(out, b, normal), add_vertex(out, c, normal), add_vertex(out, d, normal);
  add_triangle(out, v, v + 1, v + 2), add_triangle(out, v, v + 2, v + 3);
}

}  // namespace

void add_lathe(Mesh& out, Vec3d foot, const std::vector<ProfilePoint>& profile, int sides) {
  add_disc(out, foot, profile.front(), sides, false);
  for (std::size_t p = 0; p + 1 < profile.size(); ++p) {
    const ProfilePoint low = profile[p], high = profile[p + 1];
    // Its own two rings, so that edges of the profile stay sharp.
    const double rise = high.height - low.height, out_by = high.radius - low.radius,
                 l = std::hypot(rise, out_by);
    const auto base = static_cast<uint32_t>(out.positions.size());
    for (const ProfilePoint& at : {low, high})
      for (int k = 0; k < sides; ++k)
        add_vertex(out, foot + on_circle(at.radius, at.height, k, sides),
                   normalize(on_circle(rise / l, -out_by / l, k, sides)));
    const auto n = static_cast<uint32_t>(sides);
    for (uint32_t k = 0; k < n; ++k) {
      const uint32_t a = base + k, b = base + (k + 1) % n;
      add_triangle(out, a, a + n, b + n), add_triangle(out, a, b + n, b);
    }
  }
  add_disc(out, foot, profile.back(), sides, true);
}

void add_slab(Mesh& out, int columns, int rows, const SheetPoint& front, const SheetPoint& back,
              const std::function<bool(int, int)>& turned) {
  add_sheet_of(out, columns, rows, front, turned, false);
  add_sheet_of(out, columns, rows, back, turned, true);
  const auto side = [&](int i, int j, int next_i, int next_j) {
    add_flat_quad(out, front(next_i, next_j), front(i, j), back(i, j), back(next_i, next_j));
  };
  for (int i = 0; i < columns; ++i) side(i, 0, i + 1, 0), side(i + 1, rows, i, rows);
  for (int j = 0; j < rows; ++j) side(columns, j, columns, j + 1), side(0, j + 1, 0, j);
}

double arch_height(double at, double pointed) {
  const double from_center = std::abs(at) + pointed - 1;
  const double square = pointed * pointed - from_center * from_center;
  return std::sqrt(std::max(square, 0.0) / (2 * pointed - 1));
}

std::vector<double> arch_stops(int segments, double pointed) {
  std::vector<double> stops(static_cast<std::size_t>(segments) + 1);
  const int half = segments / 2;
  const double apex = std::acos((pointed - 1) / pointed);
  for (int i = 0; i <= half; ++i) {
    const double t = i == half ? 0 : 1 - pointed * (1 - std::cos(apex * i / half));
    stops[static_cast<std::size_t>(i)] = -t;
    stops[static_cast<std::size_t>(segments - i)] = t;
  }
  return stops;
}

std::vector<Vec3d> arch_line(const Arch& arch, Vec3d foot, Vec3d along) {
  std::vector<Vec3d> line;
  for (const double t : arch_stops(arch.segments, arch.pointed))
    line.push_back(foot + along * (t * arch.half_width) +
                   up * (arch.springing + arch.rise * arch_height(t, arch.pointed)));
  return line;
}

void add_arch_bar(Mesh& out, const Arch& arch, Vec3d foot, Vec3d along, double depth, double thickness) {
  const std::vector<Vec3d> inner = arch_line(arch, foot, along);
  Arch wider = arch;
  wider.half_width += depth, wider.rise += depth;
  const std::vector<Vec3d> outer = arch_line(wider, foot, along);
  const Vec3d half = cross(along, up) * (thickness / 2);
  const auto at = [&](int i, int j) { return (j ? outer : inner)[static_cast<std::size_t>(i)]; };
  add_slab(
      out, arch.segments, 1, [&](int i, int j) { return at(i, j) + half; },
      [&](int i, int j) { return at(i, j) - half; });
}

namespace {

// Where an arcade's wall begins, from left to right: openings' arches, and straight pieces between them.
std::vector<Vec3d> lower_line(const ArcadeWall& wall) {
  const double half = wall.bays * wall.bay / 2;
  std::vector<Vec3d> line{wall.foot - wall.along * (half + wall.beyond) + up * wall.arch.springing};
  for (int b = 0; b < wall.bays; ++b)
    for (const Vec3d p :
         arch_line(wall.arch, wall.foot + wall.along * ((b + 0.5) * wall.bay - half), wall.along))
      line.push_back(p);
  line.push_back(wall.foot + wall.along * (half + wall.beyond) + up * wall.arch.springing);
  return line;
}

// A box about an upright plane: from `from` to `to` along it.
void add_upright(Mesh& out, const ArcadeWall& wall, double from, double to, double low, double high,
                 double thickness) {
  const Vec3d half = cross(wall.along, up) * (thickness / 2);
  const auto at = [&](int i, int j) {
    return wall.foot + wall.along * (i ? to : from) + up * (j ? high : low);
  };
  add_slab(
      out, 1, 1, [&](int i, int j) { return at(i, j) + half; },
      [&](int i, int j) { return at(i, j) - half; });
}

}  // namespace

void add_arcade_wall(Mesh& out, const ArcadeWall& wall) {
  const std::vector<Vec3d> lower = lower_line(wall);
  const Vec3d half = cross(wall.along, up) * (wall.thickness / 2);
  const auto at = [&](int i, int j) {
    Vec3d p = lower[static_cast<std::size_t>(i)];
    if (j) p.y = wall.foot.y + wall.top;
    return p;
  };
  add_slab(
      out, static_cast<int>(lower.size()) - 1, 1, [&](int i, int j) { return at(i, j) + half; },
      [&](int i, int j) { return at(i, j) - half; });
  if (wall.sill <= 0) return;
  const double reach = wall.bays * wall.bay / 2 + wall.beyond;
  add_upright(out, wall, -reach, reach, 0, wall.sill, wall.thickness);
  // Thinner, and into what lies above and below, so that no two faces are in one plane.
  const double overlap = 0.04 * wall.thickness, thin = wall.thickness - 2 * overlap;
  for (int p = 0; p <= wall.bays; ++p) {
    const double middle = p * wall.bay - wall.bays * wall.bay / 2, pier = wall.bay / 2 - wall.arch.half_width;
    add_upright(out, wall, p == 0 ? overlap - reach : middle - pier,
                p == wall.bays ? reach - overlap : middle + pier, wall.sill - overlap,
                wall.arch.springing + overlap, thin);
  }
}

void add_vault(Mesh& out, const Vault& vault) {
  const int n = vault.arch.segments;
  const std::vector<double> stops = arch_stops(n, vault.arch.pointed);
  const auto below = [&](int i, int j) {
    const double x = stops[static_cast<std::size_t>(i)], z = stops[static_cast<std::size_t>(j)];
    const double height = arch_height(std::min(std::abs(x), std::abs(z)), vault.arch.pointed);
    return vault.center + Vec3d{vault.half_x * x, vault.arch.rise * height, vault.half_z * z};
  };
  // Cells are cut along the groins.
  add_slab(
      out, n, n, below, [&](int i, int j) { return below(i, j) + up * vault.thickness; },
      [n](int i, int j) { return (i < n / 2) != (j < n / 2); });
}

void add_vault_ribs(Mesh& out, const Vault& vault, double radius, int sides) {
  for (const double turn : {1.0, -1.0}) {
    std::vector<Vec3d> line;
    for (const double t : arch_stops(vault.arch.segments, vault.arch.pointed))
      line.push_back(vault.center + Vec3d{vault.half_x * t,
                                          vault.arch.rise * arch_height(t, vault.arch.pointed),
                                          turn * vault.half_z * t});
    add_tube(out, line, radius, sides, TubeEnds::capped, {vault.half_z, 0, -turn * vault.half_x});
  }
}

}  // namespace penumbra
