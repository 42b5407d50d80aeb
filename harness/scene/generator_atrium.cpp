// A court with two-storey arcades round it, in the character of the Sponza palace's: round columns, vaulted
// galleries below, a balustrade above, cornices with dentils, hanging cloths, a fountain and vases. Open to
// the sky. The longer side runs along x, the court's floor is y = 0, lengths are metres.
#include <numbers>

#include "scene/building_pieces.h"
#include "scene/generator_table.h"
#include "scene/mesh_builder.h"

namespace penumbra {
namespace {

constexpr double bay_length = 2.6, gallery = 2.8;  // gallery: from the columns' axis to the outer wall's
constexpr double lower_springing = 3.0, upper_floor = 4.75, upper_springing = 7.05, roof = 8.9;
constexpr Vec3d along_x{1, 0, 0}, along_z{0, 0, 1}, up{0, 1, 0};

struct Plan {
  int bays_x, bays_z, detail;
  double half_x() const { return bays_x * bay_length / 2; }
  double half_z() const { return bays_z * bay_length / 2; }
};

// One of the court's four sides: its bays stand along `along`, `out` points away from the court.
struct Side {
  Vec3d middle, along, out;
  int bays;
  Vec3d bay_edge(int b) const { return middle + along * ((b - bays / 2.0) * bay_length); }
  Vec3d bay_middle(int b) const { return middle + along * ((b + 0.5 - bays / 2.0) * bay_length); }
  bool is_long() const { return along.x != 0; }
};

std::vector<Side> sides_of(const Plan& plan) {
  std::vector<Side> sides;
  for (const double way : {-1.0, 1.0}) {
    sides.push_back({along_z * (way * plan.half_z()), along_x, along_z * way, plan.bays_x});
    sides.push_back({along_x * (way * plan.half_x()), along_z, along_x * way, plan.bays_z});
  }
  return sides;
}

// A box by the middle of its foot and its extents along a side, up and across it.
void add_block(Mesh& m, const Side& side, Vec3d foot, double along, double height, double across) {
  const Vec3d out{std::abs(side.out.x), 0, std::abs(side.out.z)};
  const Vec3d half = side.along * (along / 2) + out * (across / 2);
  add_box(m, foot - half, foot + half + up * height);
}

// 28 detail + 12 and 24 detail + 12
void add_columns(Mesh& m, const Plan& plan, const Side& side) {
  static const std::vector<ProfilePoint> lower = {
      {0.34, 0.10}, {0.34, 0.16}, {0.37, 0.21}, {0.34, 0.27}, {0.29, 0.30}, {0.27, 0.36}, {0.24, 2.55},
      {0.27, 2.58}, {0.27, 2.63}, {0.24, 2.66}, {0.26, 2.74}, {0.33, 2.86}, {0.37, 2.90}, {0.37, 2.97}};
  static const std::vector<ProfilePoint> upper = {{0.26, 0.06}, {0.26, 0.11}, {0.28, 0.15}, {0.25, 0.20},
                                                  {0.19, 0.24}, {0.16, 1.90}, {0.19, 1.93}, {0.19, 1.97},
                                                  {0.17, 2.00}, {0.22, 2.14}, {0.27, 2.18}, {0.27, 2.28}};
  const int first = side.is_long() ? 0 : 1;  // corners are the longer sides'
  for (int b = first; b <= side.bays - first; ++b) {
    const Vec3d at = side.bay_edge(b);
    add_block(m, side, at - up * 0.03, 0.8, 0.15, 0.8);
    add_lathe(m, at, lower, plan.detail);
    add_block(m, side, at + up * (upper_floor - 0.02), 0.6, 0.1, 0.6);
    add_lathe(m, at + up * upper_floor, upper, plan.detail);
  }
}

void add_walls(Mesh& m, const Plan& plan, const Side& side) {
  const int n = plan.detail;
  // Where two walls meet in a corner the shorter one ends within the longer one, a little lower.
  const double drop = side.is_long() ? 0 : 0.013, beyond = side.is_long() ? 0.22 : 0.1;
  const Vec3d foot = side.middle - up * drop;
  add_arcade_wall(m, {foot,
                      side.along,
                      side.bays,
                      bay_length,
                      0.42,
                      upper_floor - 0.1,
                      0,
                      beyond,
                      {0.9, lower_springing - 0.05, 1.0, 1, n}});
  add_arcade_wall(m, {foot,
                      side.along,
                      side.bays,
                      bay_length,
                      0.36,
                      roof,
                      0,
                      beyond,
                      {1.0, upper_springing - 0.04, 1.0, 1, n}});
  const double outer = gallery + (side.is_long() ? 0.18 : 0.05);
  add_arcade_wall(m, {foot + side.out * gallery - up * 0.05,
                      side.along,
                      side.bays,
                      bay_length,
                      0.4,
                      roof + 0.03,
                      6.0,
                      outer,
                      {0.42, 7.0, 0.42, 1, n}});
}

Vault vault_at(Vec3d center, double half_x, double half_z, int n) {
  return {center + up * lower_springing, half_x, half_z, 0.14, {1, 0, 1.3, 1, n}};
}

void add_gallery(Mesh& m, const Plan& plan, const Side& side) {
  const double half = bay_length / 2 - 0.02, deep = gallery / 2 - 0.04;
  const auto add = [&](const Vault& vault) { add_vault(m, vault), add_vault_ribs(m, vault, 0.06, 4); };
  for (int b = 0; b < side.bays; ++b) {
    const Vec3d center = side.bay_middle(b) + side.out * (gallery / 2);
    add(side.is_long() ? vault_at(center, half, deep, plan.detail)
                       : vault_at(center, deep, half, plan.detail));
  }
  // The corner at this side's end.
  const Vec3d turn = side.along * (side.is_long() ? 1.0 : -1.0) * (side.out.x + side.out.z);
  const Vec3d corner =
      side.middle + turn * (side.bays * bay_length / 2 + gallery / 2) + side.out * (gallery / 2);
  add(vault_at(corner, deep, deep, plan.detail));
  const Vec3d across{std::abs(side.out.x), 0, std::abs(side.out.z)};
  for (int b = 0; b <= side.bays; ++b)
    add_arch_bar(m, {gallery / 2 - 0.2, lower_springing, 1.12, 1, plan.detail},
                 side.bay_edge(b) + side.out * (gallery / 2), across, 0.36, 0.3);
}

// 5 x 96 + 2 x 12 + 2 x 8 x 12 a bay
void add_balustrade(Mesh& m, const Side& side) {
  static const std::vector<ProfilePoint> baluster = {{0.08, 0.0},  {0.08, 0.08}, {0.04, 0.14},
                                                     {0.09, 0.30}, {0.04, 0.56}, {0.08, 0.66}};
  for (int b = 0; b < side.bays; ++b) {
    const Vec3d middle = side.bay_middle(b) + up * upper_floor;
    add_block(m, side, middle - up * 0.02, bay_length - 0.3, 0.12, 0.24);
    add_block(m, side, middle + up * 0.72, bay_length - 0.3, 0.12, 0.26);
    for (int k = 0; k < 5; ++k) add_lathe(m, middle + side.along * ((k - 2) * 0.38) + up * 0.08, baluster, 8);
    for (const double height : {upper_floor - 0.36, roof - 0.16})
      for (int k = 0; k < 8; ++k)
        add_block(
            m, side,
            side.bay_middle(b) + side.along * ((k - 3.5) * bay_length / 8) - side.out * 0.26 + up * height,
            0.14, 0.14, 0.2);
  }
}

// Rings of four boxes: what the upper gallery stands on, and the roof, each with its cornice.
void add_floors(Mesh& m, const Plan& plan, const Side& side) {
  // The shorter sides lie between the longer ones and end within them.
  const double outer = gallery + 0.1;
  const auto ring = [&](double foot, double height, double inner, double over) {
    const double across = outer + inner + over;
    const double length =
        side.is_long() ? 2 * (plan.half_x() + outer + over) : 2 * (plan.half_z() - inner + 0.05);
    const double lower = side.is_long() ? 0 : 0.004;
    add_block(m, side, side.middle + side.out * ((outer + over - inner) / 2) + up * (foot + lower), length,
              height - 2 * lower, across);
  };
  ring(upper_floor - 0.2, 0.2, 0.38, 0);
  ring(roof - 0.04, 0.25, 0.42, 0.3);
}

// 4 x 16 x 12 + 4 (16 + 12): a cloth that hangs over the balustrade in folds.
void add_cloth(Mesh& m, const Side& side, Vec3d middle) {
  const auto at = [&](int i, int j, double depth) {
    const double s = i / 16.0 - 0.5, t = j / 12.0;
    const double fold = 0.09 * std::sin(22 * s + 2 * t) * (1.1 - 0.7 * t);
    const double sag = 0.10 * std::cos(2 * std::numbers::pi * s) * (1 - t);
    return middle + side.along * (1.5 * s) - side.out * (0.45 + fold + depth) + up * (3.0 + sag + 2.55 * t);
  };
  // cross(along, up) points out on one side of the court and in on the other.
  const double front = dot(cross(side.along, up), side.out) > 0 ? 0.0 : 0.03;
  add_slab(
      m, 16, 12, [&](int i, int j) { return at(i, j, front); },
      [&](int i, int j) { return at(i, j, 0.03 - front); });
}

// 44 detail and 4 x 18 detail
void add_fountain_and_vases(Mesh& m, const Plan& plan) {
  static const std::vector<ProfilePoint> fountain = {{1.25, -0.03}, {1.25, 0.50}, {1.10, 0.50}, {1.05, 0.18},
                                                     {0.22, 0.16},  {0.16, 0.95}, {0.62, 1.12}, {0.66, 1.22},
                                                     {0.58, 1.19},  {0.10, 1.06}, {0.05, 1.55}};
  static const std::vector<ProfilePoint> vase = {{0.24, -0.03}, {0.24, 0.06}, {0.12, 0.12},
                                                 {0.30, 0.45},  {0.34, 0.62}, {0.24, 0.80},
                                                 {0.30, 0.88},  {0.25, 0.87}, {0.20, 0.78}};
  add_lathe(m, {}, fountain, 2 * plan.detail);
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0})
      add_lathe(m, {x * (plan.half_x() - 1.6), 0, z * (plan.half_z() - 1.3)}, vase, plan.detail);
}

Mesh make_atrium(const GeneratorValues& v) {
  const Plan plan{v.integer("bays_x"), v.integer("bays_z"), v.integer("detail") / 2 * 2};
  Mesh m;
  const double reach = gallery + 0.8;
  add_box(m, {-plan.half_x() - reach, -0.4, -plan.half_z() - reach},
          {plan.half_x() + reach, 0, plan.half_z() + reach});
  for (const Side& side : sides_of(plan)) {
    add_columns(m, plan, side);
    add_walls(m, plan, side);
    add_gallery(m, plan, side);
    add_balustrade(m, side);
    add_floors(m, plan, side);
    for (int b = 1; side.is_long() && b < side.bays; b += 2) add_cloth(m, side, side.bay_middle(b));
  }
  add_fountain_and_vases(m, plan);
  return m;
}

}  // namespace

Generator atrium_generator() {
  return {{"atrium",
           "A court between two-storey arcades: vaulted galleries, balustrades, cloths, a fountain.",
           "with sides = 2 (bays_x + bays_z): (sides + 4) (4 detail^2 + 32 detail + 12) + sides (76 detail + "
           "756) + "
           "116 detail + 348 + 1760 floor(bays_x / 2)",
           {{"bays_x", "along the longer side, 2.6 each", 7, 1, 256, true},
            {"bays_z", "along the shorter side", 3, 1, 256, true},
            {"detail", "segments of an arch, sides of a column; even (an odd one counts as one less)", 14, 4,
             256, true}}},
          make_atrium};
}

}  // namespace penumbra
