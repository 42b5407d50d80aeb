#include "scene/subdivision.h"

#include <cmath>

#include "fixtures.h"
#include "scene/generators.h"

namespace penumbra::test {
namespace {

MeshHygiene hygiene_of(Mesh mesh) { return clean(mesh, "subdivided"); }

double area(const Mesh& m) {
  double sum = 0;
  for (std::size_t i = 0; i < m.indices.size(); i += 3) {
    const Vec3d a(m.positions[m.indices[i]]), b(m.positions[m.indices[i + 1]]),
        c(m.positions[m.indices[i + 2]]);
    sum += length(cross(b - a, c - a)) / 2;
  }
  return sum;
}

TEST(Subdivision, LoopMakesFourOfOneAndKeepsMeshesClosed) {
  for (const auto& [name, arguments] : std::vector<std::pair<std::string, std::vector<GeneratorArgument>>>{
           {"box", {}}, {"torus_knot", {}}, {"hair_ball", {{"strands", 10}, {"caps", 1}}}}) {
    const Mesh coarse = generate(name, arguments);
    const Mesh fine = subdivided(coarse, {2, 0}, "here");
    EXPECT_EQ(fine.triangle_count(), 16 * coarse.triangle_count()) << name;
    EXPECT_TRUE(hygiene_of(fine).closed()) << name;
    EXPECT_EQ(hygiene_of(fine).dropped_degenerate, 0U) << name;
    EXPECT_EQ(hygiene_of(fine).duplicate_vertices, 0U) << name;
  }
}

// A regular octahedron by hand: beta(4) = (5/8 - (3/8)^2) / 4 = 31/256, and the ring's sum is 0, so that a
// vertex comes to 1 - 4 x 31/256 = 33/64; the middle of an edge to 3/8 (1, 1, 0) + 1/8 (0, 0, 1 - 1).
TEST(Subdivision, LoopsPointsAreThoseOfItsRules) {
  const Mesh fine = loop_subdivided(generate("sphere", {{"columns", 4}, {"rows", 2}}));
  ASSERT_EQ(fine.triangle_count(), 32U);
  std::size_t corners = 0, middles = 0;
  for (const Vec3f p : fine.positions) {
    const float sum = std::abs(p.x) + std::abs(p.y) + std::abs(p.z),
                most = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    corners += std::abs(sum - 33.0f / 64) < 1e-6f && std::abs(most - sum) < 1e-6f;
    middles += std::abs(sum - 0.75f) < 1e-6f && std::abs(most - 0.375f) < 1e-6f;
  }
  EXPECT_EQ(corners, 6U);
  EXPECT_EQ(middles, 12U);
}

TEST(Subdivision, FlatMeshesStayFlatAndTheirBordersFollowTheirOwnCurve) {
  const Mesh fine = subdivided(generate("plane", {{"size_x", 4}, {"size_z", 4}, {"columns", 4}, {"rows", 4}}),
                               {1, 0}, "here");
  EXPECT_EQ(hygiene_of(fine).open_edges, 32U);
  Box box;
  for (const Vec3f p : fine.positions) box.extend(p);
  EXPECT_EQ(box.lo.y, 0);
  EXPECT_EQ(box.hi.y, 0);
  EXPECT_EQ(box.hi.x,
            2);  // the sides stay straight; the corners are cut, (1/8, 6/8, 1/8) of their neighbours
  bool corner = false;
  for (const Vec3f p : fine.positions) corner |= p == Vec3f{1.875f, 0, 1.875f};
  EXPECT_TRUE(corner);
}

TEST(Subdivision, SplittingGivesTheVeryCountAndKeepsTheSurface) {
  const Mesh coarse = generate("torus_knot", {{"segments", 60}, {"sides", 10}});
  for (const std::size_t target : {1202U, 2000U, 9998U}) {
    const Mesh fine = split_to(coarse, target, "here");
    EXPECT_EQ(fine.triangle_count(), target);
    EXPECT_TRUE(hygiene_of(fine).closed());
    EXPECT_EQ(hygiene_of(fine).dropped_degenerate, 0U);
    EXPECT_NEAR(area(fine), area(coarse), 1e-5 * area(coarse));
  }
  EXPECT_EQ(split_to(coarse, 1200, "here").triangle_count(), 1200U);
}

TEST(Subdivision, TheLongestEdgeIsSplitFirst) {
  // The square's diagonal; then one of its sides has one face, so that three more make six of four.
  const Mesh four = split_to(square(), 4, "here");
  bool center = false;
  for (const Vec3f p : four.positions) center |= p == Vec3f{0.5f, 0.5f, 0};
  EXPECT_TRUE(center);
  EXPECT_EQ(hygiene_of(split_to(square(), 5, "here")).open_edges, 5U);
  EXPECT_EQ(hygiene_of(split_to(square(), 5, "here")).inconsistent_edges, 0U);
}

TEST(Subdivision, EdgesOfThreeFacesStayWhereTheyAre) {
  const Mesh fan =
      mesh_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {0, 1, 2, 0, 1, 3, 0, 1, 4});
  const Mesh fine = subdivided(fan, {1, 0}, "here");
  EXPECT_EQ(hygiene_of(fine).non_manifold_edges, 2U);
  EXPECT_CONTAINS(input_error_of([&] { split_to(fan, 5, "here"); }), "no edge with two faces");
}

TEST(Subdivision, MistakesNameThePlaceAndTheNumbers) {
  EXPECT_CONTAINS(input_error_of([] { split_to(cube(), 11, "scene.json:3:4"); }),
                  "scene.json:3:4: found target_triangles = 11, expected at least the 12 that there are.");
  EXPECT_CONTAINS(input_error_of([] { split_to(cube(), 15, "here"); }),
                  "without open edges the number stays even");
  EXPECT_CONTAINS(input_error_of([] {
                    subdivided(generate("study_hair", {}), {5, 0}, "here");
                  }),
                  "at most 268435456");
  const TemporaryFolder folder;
  const auto load = [&](const std::string& subdivide) {
    return input_error_of([&] {
      load_text(folder, scene_text(R"("box": {"generator": "box", "subdivide": )" + subdivide + "}",
                                   R"({"mesh": "box"})"));
    });
  };
  EXPECT_CONTAINS(load(R"({"lop": 1})"), "Did you mean 'loop'?");
  EXPECT_CONTAINS(load(R"({"loop": 7})"), "/meshes/box/subdivide/loop");
  EXPECT_CONTAINS(load("{}"), "or both");
  EXPECT_CONTAINS(load(R"({"loop": 1, "target_triangles": 40})"), "at least the 48");
}

TEST(Subdivision, ScenesUseItBeforeTheyFit) {
  const TemporaryFolder folder;
  const Scene s = load_text(
      folder, scene_text(R"("box": {"generator": "box", "subdivide": {"loop": 3, "target_triangles": 800},
                                                  "fit": {"size": 2}})",
                         R"({"mesh": "box"})"));
  EXPECT_EQ(s.report().triangles, 800U);
  EXPECT_TRUE(s.report().meshes.front().hygiene.closed());
  const Box box = s.frame(0, "", "", -1).geometry.bounds;
  EXPECT_FLOAT_EQ(box.hi.y, 2);
  EXPECT_NEAR(box.lo.y, 0, 1e-6);
}

}  // namespace
}  // namespace penumbra::test
