// Line spaces and their trees: shafts against exact arithmetic, trees against their definition, the formula
// of their bytes, and the source's table.
#include "tests/techniques/line_space_tree.h"

#include <random>

#include "core/error.h"
#include "techniques/line_space/device_tree.h"
#include "tests/support/stage.h"

namespace penumbra::test {
namespace {

using testing::device;

constexpr std::array<std::array<int, 2>, 5> paper_sets{{{4, 4}, {5, 4}, {6, 3}, {7, 3}, {8, 3}}};

// --- shafts
// -----------------------------------------------------------------------------------------------------------

TEST(Shafts, EachPairOfSubsidesHasOneBitWhicheverEndComesFirst) {
  for (uint32_t n : {2U, 5U, 8U})
    for (uint32_t i = 0; i < 15 * n * n * n * n; ++i) {
      const Shaft s = shaft_at(n, i);
      ASSERT_LT(s.side[0], s.side[1]);
      ASSERT_LT(s.side[1], 6U);
      ASSERT_EQ(shaft_index(n, s), i);
      ASSERT_EQ(shaft_index(n, {{s.side[1], s.side[0]}, {s.subside[1], s.subside[0]}}), i);
    }
}

std::array<Vec3d, 4> corners_of(int n, uint32_t side, uint32_t subside) {
  std::array<Vec3d, 4> c;
  const int axis = static_cast<int>(side / 2), u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  for (int k = 0; k < 4; ++k) {
    Vec3d& p = c[static_cast<std::size_t>(k)];
    p[axis] = side % 2 ? n : 0;
    p[u] = static_cast<int>(subside) % n + k % 2;
    p[v] = static_cast<int>(subside) / n + k / 2;
  }
  return c;
}

// Separating axes of two convex bodies in whole numbers: another method than the table's.
bool share_inner_points(int n, const Shaft& shaft, Vec3d cube) {
  const auto a = corners_of(n, shaft.side[0], shaft.subside[0]),
             b = corners_of(n, shaft.side[1], shaft.subside[1]);
  std::vector<Vec3d> edges{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vec3d& p : a)
    for (const Vec3d& q : b) edges.push_back(q - p);
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3d axis = cross(edges[i], edges[j]);
      if (dot(axis, axis) == 0) continue;
      double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
      const auto extend = [&](int body, Vec3d p) {
        lo[body] = std::min(lo[body], dot(axis, p)), hi[body] = std::max(hi[body], dot(axis, p));
      };
      for (const Vec3d& p : a) extend(0, p);
      for (const Vec3d& p : b) extend(0, p);
      for (int k = 0; k < 8; ++k) extend(1, cube + Vec3d{double(k & 1), double(k >> 1 & 1), double(k >> 2)});
      if (hi[0] <= lo[1] || hi[1] <= lo[0]) return false;
    }
  return true;
}

TEST(Shafts, MeetASubnodeExactlyWhereNoAxisSeparatesThem) {
  for (int n : {2, 3}) {
    const auto un = static_cast<uint32_t>(n);
    const ShaftTable table(un);
    for (uint32_t c = 0; c < un * un * un; ++c)
      for (uint32_t i = 0; i < table.shafts(); ++i) {
        const bool bit = table.row(c)[i / 32] >> (i % 32) & 1;
        const Vec3d cube{double(c % un), double(c / un % un), double(c / un / un)};
        ASSERT_EQ(bit, share_inner_points(n, shaft_at(un, i), cube)) << n << ": " << c << ", " << i;
      }
  }
}

// --- the tree
// ---------------------------------------------------------------------------------------------------------

TEST(LineSpaceTree, TakesTheBytesOfTheFormula) {
  for (const auto [n, d] : paper_sets) {
    const double formula = 15.0 * n * n * n * n / 8 + 4.0 * n * n * n + 16;
    EXPECT_NEAR(double(pool_bytes(static_cast<uint32_t>(n), 1000).total()), 1000 * formula,
                0.02 * 1000 * formula);
  }
}

TEST(LineSpaceTree, HasAsManyNodesAsTheSourceWithinAHalf) {
  // [Keul2017, table 1], thousands, in the order of paper_sets.
  const struct {
    const char* scene;
    double nodes[5], mib[5];
  } table[] = {{"bunny_original", {13, 57.2, 3.9, 8.1, 12.4}, {9.4, 92, 12.3, 45.6, 115.2}},
               {"dragon", {13.8, 60.7, 4.1, 8.7, 13.2}, {9.9, 97.7, 13.1, 48.7, 122.2}}};
  for (const auto& row : table) {
    const Frame frame = Scene::load(row.scene, {"configs/scenes"}).frame(0, "key", "", -1);
    const std::vector<uint32_t> casters = select_casters(
        frame.geometry, faces_before_light(frame.geometry.bounds, make_light_samples(frame.light, {5, 5})));
    EXPECT_EQ(casters.size(), frame.geometry.triangle_count() - 2) << "the ground cannot block";
    for (std::size_t i = 0; i < paper_sets.size(); ++i) {
      const auto [n, d] = paper_sets[i];
      const Tree tree(frame.geometry, casters, params_of(n, d));
      const double nodes = double(tree.pools.nodes.size()) / 1000;
      const double mib =
          double(pool_bytes(static_cast<uint32_t>(n), tree.pools.nodes.size()).total()) / (1 << 20);
      std::printf("[measured] %s (%d, %d): %.1f thousand nodes, source %.1f; %.1f MiB, source %.1f\n",
                  row.scene, n, d, nodes, row.nodes[i], mib, row.mib[i]);
      EXPECT_LT(nodes, 1.5 * row.nodes[i]);
      EXPECT_GT(nodes, row.nodes[i] / 1.5);
      EXPECT_NEAR(mib / nodes, row.mib[i] / row.nodes[i], 0.02 * mib / nodes) << "bytes per node";
    }
  }
}

// A node's line space by its definition, from its occupied subnodes.
TEST(LineSpaceTree, AShaftIsEmptyOnlyWhereItMeetsNoOccupiedSubnode) {
  const Geometry g = soup(40, 0.3f, 3);
  const Tree tree(g, params_of(3, 3));
  const uint32_t n = 3, subnodes = 27;
  for (std::size_t i = 0; i < tree.pools.nodes.size(); ++i)
    for (uint32_t s = 0; s < tree.table.shafts(); ++s) {
      bool occupied = false;
      for (uint32_t c = 0; c < subnodes; ++c)
        occupied = occupied || (tree.pools.tree[i * subnodes + c] != empty_leaf &&
                                meets(n, shaft_at(n, s), c % n, c / n % n, c / n / n));
      ASSERT_EQ(tree.pools.line_space[i * tree.table.words() + s / 32] >> (s % 32) & 1, occupied);
    }
}

// Leaves by the oracle's distance in double precision.
TEST(LineSpaceTree, HoldsEveryLeafThatATriangleTouchesAndFewOthers) {
  Geometry g = soup(30, 0.4f, 5);
  testing::add_triangle(g, {-0.9f, 0, 0}, {0.9f, 1e-6f, 0}, {0, 0, 1e-7f});  // a sliver
  const Tree tree(g, params_of(4, 2));
  const int leaves = 16;
  const Vec3d size = Vec3d(tree.grid.size) / double(leaves), lo(tree.grid.lo);
  std::size_t listed = 0, touched = 0;
  for (int z = 0; z < leaves; ++z)
    for (int y = 0; y < leaves; ++y)
      for (int x = 0; x < leaves; ++x) {
        const auto place = [](int px, int py, int pz) {
          return static_cast<std::size_t>((pz * 4 + py) * 4 + px);
        };
        const uint32_t node = tree.pools.tree[place(x / 4, y / 4, z / 4)];
        const bool in_tree =
            node < occupied_leaf && tree.pools.tree[node * 64 + place(x % 4, y % 4, z % 4)] == occupied_leaf;
        // A triangle meets a box where a point of it is inside, found by cutting it into small pieces.
        bool meets_box = false;
        const Vec3d a = lo + Vec3d{x * size.x, y * size.y, z * size.z}, b = a + size;
        for (std::size_t t = 0; t < g.triangle_count() && !meets_box; ++t)
          for (int i = 0; i <= 60 && !meets_box; ++i)
            for (int j = 0; i + j <= 60 && !meets_box; ++j) {
              const Vec3d p = Vec3d(g.corner(t, 0)) * ((60 - i - j) / 60.0) +
                              Vec3d(g.corner(t, 1)) * (i / 60.0) + Vec3d(g.corner(t, 2)) * (j / 60.0);
              meets_box = p.x >= a.x && p.x <= b.x && p.y >= a.y && p.y <= b.y && p.z >= a.z && p.z <= b.z;
            }
        listed += in_tree, touched += meets_box;
        EXPECT_TRUE(in_tree || !meets_box) << x << ", " << y << ", " << z;
      }
  EXPECT_GT(touched, 200U);
  EXPECT_LT(double(listed), 1.1 * double(touched));
}

TEST(LineSpaceTree, IsTheSameFromTheDeviceAsFromTheHost) {
  std::vector<Frame> frames(3);
  frames[0].geometry = soup(60, 0.5f, 6);
  frames[1].geometry = soup(600, 0.05f, 8);
  testing::add_triangle(frames[1].geometry, {-1, -0.7f, 0}, {1, 0.8f, 0}, {1, -0.7f, 0.1f});
  testing::add_ground(frames[2].geometry, 2);  // a tree of one flat square
  for (const auto [n, d] : {std::array{4, 4}, {7, 2}, {10, 2}, {2, 5}, {5, 3}, {3, 1}}) {
    SCOPED_TRACE(std::to_string(n) + ", " + std::to_string(d));
    line_space::Params params = params_of(n, d);
    params.cells = d % 2 ? line_space::Params::Cells::fitted : line_space::Params::Cells::cubic;
    DeviceTree tree;
    tree.setup(device(), static_cast<uint32_t>(n));
    for (const Frame& frame : frames)
      for (const bool empty : {false, true}) {
        const std::vector<uint32_t> casters =
            empty ? std::vector<uint32_t>{} : select_casters(frame.geometry, 0);
        const Tree host(frame.geometry, casters, params);
        gpu::PassRecorder passes(device());
        GeometryOnDevice geometry;
        geometry.update(device(), frame, passes);
        tree.build(geometry, casters, host.grid, host.table, 4096, passes);
        EXPECT_TRUE(tree.download(host.grid, passes) == host.pools);
        EXPECT_EQ(host.pools.nodes.size() == 1, empty || d == 1);
      }
  }
  EXPECT_TRUE(device().validation_messages().empty()) << device().validation_messages().front();
}

TEST(LineSpaceTree, SaysThatItNeedsMoreMemoryThanItMayTake) {
  const Geometry g = soup(3000, 0.1f, 4);
  line_space::Params params = params_of(8, 3);
  params.memory_limit_mib = 20;
  EXPECT_THROW(Tree(g, params), PointError);
  Frame frame;
  frame.geometry = g;
  gpu::PassRecorder passes(device());
  GeometryOnDevice geometry;
  geometry.update(device(), frame, passes);
  const std::vector<uint32_t> casters = select_casters(g, 0);
  DeviceTree tree;
  tree.setup(device(), 8);
  EXPECT_THROW(tree.build(geometry, casters, make_grid(g, casters, params), ShaftTable(8), 20, passes),
               PointError);
  EXPECT_THROW(check_memory(8, 1 << 21, 0, 1 << 20), PointError) << "places of 32 bits";
}

}  // namespace
}  // namespace penumbra::test
