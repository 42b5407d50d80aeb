#include <cmath>
#include <limits>

#include "fixtures.h"
#include "scene/generators.h"

namespace penumbra::test {
namespace {

TEST(Hygiene, CubeIsClosedAndUntouched) {
  Mesh m = cube();
  const MeshHygiene h = clean(m, "cube");
  EXPECT_TRUE(h.closed());
  EXPECT_EQ(h.triangles_in, 12U);
  EXPECT_EQ(m.indices, cube().indices);
  EXPECT_EQ(m.positions, cube().positions);
}

TEST(Hygiene, NanVertexDropsItsTrianglesAndItself) {
  Mesh m = square();
  m.positions[3].y = std::numeric_limits<float>::quiet_NaN();
  const MeshHygiene h = clean(m, "nan");
  EXPECT_EQ(h.dropped_not_finite, 1U);
  EXPECT_EQ(m.triangle_count(), 1U);
  for (const Vec3f p : m.positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
}

TEST(Hygiene, InfiniteVertexIsNotFinite) {
  Mesh m = square();
  m.positions[1].x = std::numeric_limits<float>::infinity();
  EXPECT_EQ(clean(m, "infinite").dropped_not_finite, 1U);
}

TEST(Hygiene, OutOfRangeIndexDropsItsTriangle) {
  Mesh m = square();
  m.indices[5] = 4;
  const MeshHygiene h = clean(m, "out of range");
  EXPECT_EQ(h.dropped_index, 1U);
  EXPECT_EQ(m.triangle_count(), 1U);
}

TEST(Hygiene, OnePointIsRefusedByName) {
  Mesh m = mesh_of({{1, 2, 3}}, {});
  EXPECT_CONTAINS(input_error_of([&] { clean(m, "point.obj"); }), "point.obj: no triangle is left");
  Mesh collapsed = mesh_of({{1, 2, 3}}, {0, 0, 0});
  EXPECT_CONTAINS(input_error_of([&] { clean(collapsed, "point.obj"); }), "1 without area");
}

TEST(Hygiene, EmptyMeshIsRefused) {
  Mesh m;
  EXPECT_CONTAINS(input_error_of([&] { clean(m, "empty"); }), "no triangle is left");
}

TEST(Hygiene, DegenerateTrianglesAreDroppedByIndexPositionAndArea) {
  Mesh m = square();
  m.positions.push_back({0, 0, 0});  // 4: same place as 0
  m.positions.push_back({2, 0, 0});  // 5: in line with 0 and 1
  m.indices.insert(m.indices.end(), {1, 1, 2, 0, 4, 2, 0, 1, 5});
  const MeshHygiene h = clean(m, "degenerate");
  EXPECT_EQ(h.dropped_degenerate, 3U);
  EXPECT_EQ(m.triangle_count(), 2U);
}

TEST(Hygiene, TinyTrianglesHaveArea) {
  Mesh m = mesh_of({{1, 1, 1}, {1.0000001f, 1, 1}, {1, 1.0000001f, 1}}, {0, 1, 2});
  EXPECT_EQ(clean(m, "tiny").dropped_degenerate, 0U);
}

TEST(Hygiene, OpenEdgesAreCounted) {
  Mesh m = cube();
  m.indices.resize(33);
  const MeshHygiene h = clean(m, "open");
  EXPECT_EQ(h.open_edges, 3U);
  EXPECT_FALSE(h.closed());
}

TEST(Hygiene, NonManifoldEdgesAreCounted) {
  Mesh m = cube();
  m.positions.push_back({0.5f, 0.5f, 3});
  m.indices.insert(m.indices.end(), {4, 5, 8});
  const MeshHygiene h = clean(m, "fin");
  EXPECT_EQ(h.non_manifold_edges, 1U);
  EXPECT_EQ(h.open_edges, 2U);
}

TEST(Hygiene, InconsistentWindingIsCounted) {
  Mesh m = cube();
  std::swap(m.indices[0], m.indices[1]);
  const MeshHygiene h = clean(m, "flipped face");
  EXPECT_EQ(h.inconsistent_edges, 3U);
  EXPECT_FALSE(h.closed());
}

TEST(Hygiene, DuplicateVerticesAreCountedNotRemoved) {
  Mesh m = generate("box", {});
  EXPECT_EQ(clean(m, "box").duplicate_vertices, 16U);
  EXPECT_EQ(m.positions.size(), 24U);
}

TEST(Hygiene, MissingNormalsAreMadeByArea) {
  Mesh m = cube();
  clean(m, "cube");
  ASSERT_EQ(m.normals.size(), 8U);
  for (std::size_t v = 0; v < 8; ++v) {
    EXPECT_NEAR(length(m.normals[v]), 1, 1e-6);
    EXPECT_GT(dot(m.normals[v], m.positions[v] - Vec3f{0.5f, 0.5f, 0.5f}), 0) << v;
  }
}

TEST(Hygiene, BadNormalsAreReplacedGoodOnesKept) {
  Mesh m = square();
  m.normals = {{0, 0, 2}, {0, 0, 0}, {NAN, 0, 0}, {1, 0, 0}};
  clean(m, "normals");
  EXPECT_EQ(m.normals[0], (Vec3f{0, 0, 1}));
  EXPECT_EQ(m.normals[1], (Vec3f{0, 0, 1}));
  EXPECT_EQ(m.normals[2], (Vec3f{0, 0, 1}));
  EXPECT_EQ(m.normals[3], (Vec3f{1, 0, 0}));
}

}  // namespace
}  // namespace penumbra::test
