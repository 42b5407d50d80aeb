// A church in the character of the sources' one: a nave between two rows of piers, aisles, ribbed groined
// vaults, traceried windows, benches, an altar and chandeliers. The nave runs along z, the altar stands at
// its negative end, the floor is y = 0, lengths are metres.
#include <numbers>

#include "scene/building_pieces.h"
#include "scene/generator_table.h"
#include "scene/mesh_builder.h"

namespace penumbra {
namespace {

constexpr double bay_length = 4.6, pier_x = 3.8, wall_x = 7.4;  // axes of piers and of the outer walls
constexpr double springing = 3.4, arcade_top = 7.2, wall_top = 12.2;
constexpr Vec3d along_x{1, 0, 0}, along_z{0, 0, 1};

struct Plan {
  int bays, detail, benches;
  double length() const { return bays * bay_length; }
  double bay_middle(int b) const { return (b + 0.5) * bay_length - length() / 2; }
  double bay_edge(int b) const { return b * bay_length - length() / 2; }
};

void add_block(Mesh& m, Vec3d middle_of_foot, Vec3d size) {
  const Vec3d half{size.x / 2, 0, size.z / 2};
  add_box(m, middle_of_foot - half, middle_of_foot + half + Vec3d{0, size.y, 0});
}

void add_rod(Mesh& m, Vec3d from, Vec3d to, double radius, int sides = 6) {
  add_tube(m, {from, to}, radius, sides, TubeEnds::capped);
}

// 28 detail + 12 + 3 x 28
void add_pier(Mesh& m, const Plan& plan, double side, double z) {
  static const std::vector<ProfilePoint> profile = {
      {0.62, -0.05}, {0.62, 0.25}, {0.55, 0.30}, {0.55, 0.42}, {0.48, 0.50}, {0.42, 0.55}, {0.40, 2.80},
      {0.46, 2.85},  {0.46, 2.92}, {0.42, 2.97}, {0.48, 3.10}, {0.60, 3.25}, {0.66, 3.30}, {0.66, 3.43}};
  const Vec3d foot{side * pier_x, 0, z};
  add_lathe(m, foot, profile, plan.detail);
  add_block(m, foot + Vec3d{0, 3.38, 0}, {1.0, 0.14, 1.0});
  // Shafts on the side of the nave, up to the vault.
  for (const double offset : {-0.24, 0.0, 0.24})
    add_rod(m, foot + Vec3d{-side * 0.34, 3.47, offset}, foot + Vec3d{-side * 0.34, 7.75, offset}, 0.11, 8);
}

Arch lancet(double half_width, double springing_height, double rise, int segments) {
  return {half_width, springing_height, rise, 1.4, segments};
}

// 36 segments + 96: a mullion, two small arches, a ring above them and three bars.
void add_tracery(Mesh& m, const ArcadeWall& wall, Vec3d foot) {
  const Arch& arch = wall.arch;
  const double w = arch.half_width, radius = 0.05 + 0.01 * w;
  const Vec3d up{0, 1, 0}, through = cross(wall.along, up);
  const double ring_height = arch.springing + 0.55 * arch.rise, ring_radius = 0.3 * w;
  add_rod(m, foot + up * (wall.sill - 0.05), foot + up * (ring_height - ring_radius), radius);
  for (const double side : {-1.0, 1.0}) {
    // Narrower than half, so that the two share no edge within the mullion.
    const Arch small{0.49 * w, arch.springing - 0.1 * arch.rise, 0.55 * arch.rise, 1.4, arch.segments};
    add_tube(m, arch_line(small, foot + wall.along * (side * w / 2), wall.along), radius, 6, TubeEnds::capped,
             through);
  }
  std::vector<Vec3d> ring;
  for (int k = 0; k < arch.segments; ++k) {
    const double a = 2 * std::numbers::pi * k / arch.segments;
    ring.push_back(foot + up * (ring_height + ring_radius * std::sin(a)) +
                   wall.along * (ring_radius * std::cos(a)));
  }
  add_tube(m, ring, radius, 6, TubeEnds::joined, through);
  for (int bar = 1; bar <= 3; ++bar) {
    const Vec3d middle = foot + up * (wall.sill + (arch.springing - wall.sill) * bar / 4);
    add_rod(m, middle - wall.along * (w + 0.05), middle + wall.along * (w + 0.05), 0.6 * radius);
  }
}

void add_windowed_wall(Mesh& m, const ArcadeWall& wall) {
  add_arcade_wall(m, wall);
  for (int b = 0; b < wall.bays; ++b)
    add_tracery(m, wall, wall.foot + wall.along * ((b + 0.5 - wall.bays / 2.0) * wall.bay));
}

void add_walls(Mesh& m, const Plan& plan) {
  const int n = plan.detail;
  for (const double side : {-1.0, 1.0}) {
    const auto wall = [&](double x, double y, double thickness, double top, double sill, const Arch& arch) {
      return ArcadeWall{{side * x, y, 0}, along_z, plan.bays, bay_length, thickness, top, sill, 0.2, arch};
    };
    add_arcade_wall(m, wall(pier_x, 0, 0.6, arcade_top, 0, lancet(1.75, springing, 2.3, n)));
    add_windowed_wall(m, wall(wall_x, -0.05, 0.6, 6.35, 1.5, lancet(0.8, 3.4, 1.5, n)));
    const double clerestory = arcade_top - 0.06;
    add_windowed_wall(m,
                      wall(pier_x, clerestory, 0.5, wall_top - clerestory, 1.1, lancet(0.85, 2.2, 1.4, n)));
    const double z = side * (plan.length() / 2 + 0.25);
    add_windowed_wall(
        m, {{0, -0.04, z}, along_x, 1, 2 * pier_x, 0.5, wall_top, 3.2, 0.25, lancet(1.7, 6.6, 2.6, n)});
    for (const double aisle : {-1.0, 1.0})
      add_block(m, {aisle * (pier_x + wall_x) / 2, -0.05, z}, {wall_x - pier_x + 0.2, 6.3, 0.42});
  }
}

// A vault with its ribs and the boss where they cross: 4 n^2 + 8 n, 24 n + 16, 80.
void add_ribbed_vault(Mesh& m, const Vault& vault, double rib) {
  add_vault(m, vault);
  add_vault_ribs(m, vault, rib, 6);
  add_ellipsoid(m, vault.center + Vec3d{0, vault.arch.rise - rib / 2, 0}, {2.2 * rib, 1.5 * rib, 2.2 * rib},
                8, 6);
}

void add_vaults(Mesh& m, const Plan& plan) {
  const int n = plan.detail;
  // A little short of the bay, so that vaults beside each other share no edge: the arch between covers the
  // gap.
  const double half_z = bay_length / 2 - 0.02, aisle_x = (pier_x + wall_x) / 2;
  for (int b = 0; b < plan.bays; ++b) {
    const double z = plan.bay_middle(b);
    add_ribbed_vault(m, {{0, 7.6, z}, 3.62, half_z, 0.2, lancet(1, 0, 3.9, n)}, 0.12);
    for (const double side : {-1.0, 1.0})
      add_ribbed_vault(m, {{side * aisle_x, springing, z}, 1.65, half_z, 0.15, lancet(1, 0, 2.5, n)}, 0.09);
  }
  for (int b = 0; b <= plan.bays; ++b) {
    const double z = plan.bay_edge(b);
    add_arch_bar(m, lancet(3.3, 7.6, 3.65, n), {0, 0, z}, along_x, 0.45, 0.4);
    for (const double side : {-1.0, 1.0})
      add_arch_bar(m, lancet(1.4, springing, 2.3, n), {side * aisle_x, 0, z}, along_x, 0.35, 0.34);
  }
}

// 6 x 12
void add_bench(Mesh& m, double x, double z) {
  const double width = 2.2;
  add_block(m, {x, 0.42, z}, {width, 0.05, 0.40});
  add_block(m, {x, 0.30, z + 0.22}, {width, 0.65, 0.06});
  add_block(m, {x, 0.13, z - 0.45}, {width, 0.05, 0.16});  // to kneel on
  add_block(m, {x, 0.78, z + 0.31}, {width, 0.03, 0.16});  // for books
  for (const double side : {-1.0, 1.0})
    add_block(m, {x + side * (width / 2 - 0.02), -0.03, z - 0.04}, {0.08, 1.03, 0.94});
}

// 7 x 12 + 2 x 192
void add_altar(Mesh& m, const Plan& plan) {
  static const std::vector<ProfilePoint> candlestick = {{0.10, -0.01}, {0.10, 0.03}, {0.03, 0.06},
                                                        {0.03, 0.30},  {0.07, 0.34}, {0.07, 0.37},
                                                        {0.03, 0.39},  {0.03, 0.75}};
  const double z = -plan.length() / 2 + 2.2;
  for (int step = 0; step < 3; ++step)
    add_block(m, {0, -0.04 + 0.01 * step, z}, {5.6 - 0.8 * step, 0.2 + 0.16 * step, 4.0 - 0.8 * step});
  add_block(m, {0, 0.4, z - 0.4}, {2.0, 0.9, 0.8});
  add_block(m, {0, 1.26, z - 0.4}, {2.3, 0.1, 1.0});
  add_block(m, {0, 1.34, z - 0.5}, {0.1, 1.5, 0.1});
  add_block(m, {0, 2.33, z - 0.5}, {0.8, 0.1, 0.085});
  for (const double side : {-1.0, 1.0}) add_lathe(m, {side * 0.85, 1.36, z - 0.4}, candlestick, 12);
}

// 12 detail + 5 x 20 + 8 x 48
void add_chandelier(Mesh& m, const Plan& plan, double z) {
  constexpr double radius = 1.0, height = 5.0, top = 6.6;
  static const std::vector<ProfilePoint> candle = {{0.07, -0.02}, {0.07, 0.06}, {0.035, 0.07}, {0.035, 0.34}};
  const auto on_ring = [&](double turns) {
    const double a = 2 * std::numbers::pi * turns;
    return Vec3d{radius * std::cos(a), height, z + radius * std::sin(a)};
  };
  std::vector<Vec3d> ring;
  for (int k = 0; k < plan.detail; ++k) ring.push_back(on_ring(double(k) / plan.detail));
  add_tube(m, ring, 0.05, 6, TubeEnds::joined, {0, 1, 0});
  for (int k = 0; k < 4; ++k) add_rod(m, on_ring((k + 0.25) / 4), {0, top, z}, 0.02);
  add_rod(m, {0, top - 0.05, z}, {0, 11.6, z}, 0.03);
  for (int k = 0; k < 8; ++k) add_lathe(m, on_ring(k / 8.0) + Vec3d{0, 0.04, 0}, candle, 6);
}

Mesh make_church(const GeneratorValues& v) {
  const Plan plan{v.integer("bays"), v.integer("detail") / 2 * 2, v.integer("benches")};
  Mesh m;
  add_block(m, {0, -0.4, 0}, {2 * wall_x + 1.6, 0.4, plan.length() + 2});
  for (int b = 0; b <= plan.bays; ++b)
    for (const double side : {-1.0, 1.0}) add_pier(m, plan, side, plan.bay_edge(b));
  add_walls(m, plan);
  add_vaults(m, plan);
  for (int row = 0; row < plan.benches; ++row)
    for (const double side : {-1.0, 1.0})
      add_bench(m, side * 1.9, plan.length() / 2 - 2.2 - (plan.length() - 9) * row / plan.benches);
  add_altar(m, plan);
  for (int b = 1; b < plan.bays; b += 2) add_chandelier(m, plan, plan.bay_middle(b));
  return m;
}

}  // namespace

Generator church_generator() {
  return {{"church",
           "A vaulted church: nave, piers, aisles, traceried windows, benches, altar, chandeliers.",
           "12 bays (detail^2 + 8 detail + 24) + (bays + 1) (80 detail + 204) + 48 bays detail + 96 bays + "
           "16 detail + "
           "808 + (4 bays + 2) (36 detail + 96) + 144 benches + floor(bays / 2) (12 detail + 484)",
           {{"bays", "of the nave, 4.6 long each", 6, 2, 64, true},
            {"detail", "segments of an arch, sides of a pier; even (an odd one counts as one less)", 18, 4,
             256, true},
            {"benches", "rows, each of two", 12, 0, 256, true}}},
          make_church};
}

}  // namespace penumbra
