#include "scene/building_pieces.h"

#include <cmath>
#include <numbers>

#include "fixtures.h"

namespace penumbra::test {
namespace {

double volume(const Mesh& m) {
  double sum = 0;
  for (std::size_t i = 0; i < m.indices.size(); i += 3)
    sum += dot(Vec3d(m.positions[m.indices[i]]),
               cross(Vec3d(m.positions[m.indices[i + 1]]), Vec3d(m.positions[m.indices[i + 2]])));
  return sum / 6;
}

void expect_closed(Mesh m, std::size_t triangles, const char* what) {
  EXPECT_EQ(m.triangle_count(), triangles) << what;
  EXPECT_GT(volume(m), 0) << what;
  const MeshHygiene h = clean(m, what);
  EXPECT_TRUE(h.closed()) << what;
  EXPECT_EQ(h.dropped_degenerate, 0U) << what;
}

TEST(BuildingPieces, ArchesAreCircularArcs) {
  for (const double pointed : {1.0, 1.4, 3.0}) {
    EXPECT_DOUBLE_EQ(arch_height(0, pointed), 1);
    EXPECT_NEAR(arch_height(1, pointed), 0, 1e-12);
    EXPECT_NEAR(arch_height(-1, pointed), 0, 1e-12);
    // Every point is as far from the arc's centre, scaled to the apex: sqrt(2 pointed - 1).
    for (const double t : {0.1, 0.35, 0.8}) {
      const double x = t + pointed - 1, y = arch_height(t, pointed) * std::sqrt(2 * pointed - 1);
      EXPECT_NEAR(std::hypot(x, y), pointed, 1e-12);
    }
    const std::vector<double> stops = arch_stops(12, pointed);
    EXPECT_EQ(stops.size(), 13U);
    EXPECT_EQ(stops.front(), -1);
    EXPECT_EQ(stops[6], 0);
    EXPECT_EQ(stops.back(), 1);
    EXPECT_TRUE(std::is_sorted(stops.begin(), stops.end()));
  }
}

TEST(BuildingPieces, LathesHaveTheVolumeOfTheirProfile) {
  Mesh cone;  // a frustum from radius 2 to 1, 3 high
  add_lathe(cone, {1, 2, 3}, {{2, 0}, {1, 3}}, 400);
  EXPECT_NEAR(volume(cone), std::numbers::pi * 3 * (4 + 2 + 1) / 3, 2e-3);
  expect_closed(cone, 2 * 400 * 2, "frustum");
  Mesh bowl;  // its inner wall goes down
  add_lathe(bowl, {}, {{2, 0}, {2, 2}, {1, 2}, {1, 1}}, 12);
  expect_closed(bowl, 2 * 12 * 4, "bowl");
}

TEST(BuildingPieces, CountsAreWhatTheHeaderSays) {
  Mesh slab;
  add_slab(
      slab, 3, 5, [](int i, int j) { return Vec3d(i, j, 1); }, [](int i, int j) { return Vec3d(i, j, 0); });
  expect_closed(slab, 4 * 15 + 4 * 8, "slab");
  EXPECT_NEAR(volume(slab), 15, 1e-6);
  const Arch arch{1, 2, 1.5, 1.3, 10};
  Mesh bar;
  add_arch_bar(bar, arch, {}, {1, 0, 0}, 0.2, 0.3);
  expect_closed(bar, 8 * 10 + 4, "bar");
  for (const double sill : {0.0, 0.5}) {
    Mesh wall;
    add_arcade_wall(wall, {{}, {0, 0, 1}, 3, 3, 0.4, 5, sill, 0.2, arch});
    expect_closed(wall, 8 * (3 * 10 + 3 + 1) + 4 + (sill > 0 ? 12U * 5 : 0U), "wall");
  }
  const Vault vault{{1, 2, 3}, 2, 3, 0.2, arch};
  Mesh shell, ribs;
  add_vault(shell, vault);
  expect_closed(shell, 4 * 100 + 8 * 10, "vault");
  add_vault_ribs(ribs, vault, 0.1, 6);
  expect_closed(ribs, 2 * (2 * 6 * 10 + 2 * 4), "ribs");
}

// Above the middle of a wall a groined vault is the barrel across; along the diagonals both barrels meet.
TEST(BuildingPieces, VaultsAreTheUpperOfTwoBarrels) {
  Mesh m;
  const Vault vault{{}, 2, 3, 0.2, {1, 0, 1.5, 1, 16}};
  add_vault(m, vault);
  float crown = 0;
  for (const Vec3f p : m.positions) {
    crown = std::max(crown, p.y);
    const double lower = 1.5 * std::max(std::sqrt(std::max(0.0, 1 - double(p.x) * p.x / 4)),
                                        std::sqrt(std::max(0.0, 1 - double(p.z) * p.z / 9)));
    EXPECT_LT(std::min(std::abs(p.y - lower), std::abs(p.y - lower - 0.2)), 2e-3) << p.x << ' ' << p.z;
  }
  EXPECT_FLOAT_EQ(crown, 1.7f);
}

}  // namespace
}  // namespace penumbra::test
