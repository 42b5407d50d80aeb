#include "fixtures.h"
#include "scene/generators.h"
#include "scene/random.h"

namespace penumbra::test {
namespace {

struct Case {
  std::string generator;
  std::vector<GeneratorArgument> arguments;
  std::size_t triangles;
  bool closed;
};

// The counts that configs/scenes/README.md documents.
const std::vector<Case>& cases() {
  static const std::vector<Case> list = {
      {"plane", {}, 2, false},
      {"plane", {{"columns", 7}, {"rows", 5}}, 70, false},
      {"box", {}, 12, true},
      {"sphere", {}, 960, true},
      {"sphere", {{"columns", 3}, {"rows", 2}}, 6, true},
      {"torus", {}, 4096, true},
      {"torus_knot", {{"segments", 60}, {"sides", 10}}, 1200, true},
      {"torus_knot", {}, 12000, true},
      {"torus_knot", {{"segments", 600}, {"sides", 20}}, 24000, true},
      {"columns", {}, 840, false},
      {"columns", {{"floor_columns", 0}}, 800, true},
      {"city", {}, 4800, true},
      {"hair_ball", {}, 44040, false},
      {"hair_ball", {{"strands", 10}, {"caps", 1}}, 1220, true},
      {"bird_nest", {}, 146880, false},
      {"bird_nest", {{"caps", 1}}, 154880, true},
      {"bird_nest", {{"twigs", 5}, {"eggs", 0}, {"sides", 3}, {"segments", 2}}, 60, false},
      {"ring_field", {}, 379096, false},
      {"ring_field", {{"blades", 0}, {"rings", 3}}, 12288, true},
      {"church", {}, 76960, true},
      {"church", {{"bays", 3}, {"detail", 9}, {"benches", 1}}, 17324, true},
      {"atrium", {}, 73508, true},
      {"atrium", {{"bays_x", 3}, {"bays_z", 2}, {"detail", 6}}, 19796, true},
      {"study_city", {}, 4800, true},
      {"study_knots", {}, 69120, true},
      {"study_nest", {}, 170000, true},
      {"study_hair", {}, 476000, true},
  };
  return list;
}

TEST(Generators, TriangleCountsAreExact) {
  for (const Case& c : cases())
    EXPECT_EQ(generate(c.generator, c.arguments).triangle_count(), c.triangles) << c.generator;
}

TEST(Generators, EveryGeneratorIsCounted) {
  for (const GeneratorInfo& g : generators()) {
    bool counted = false;
    for (const Case& c : cases()) counted |= c.generator == g.name;
    EXPECT_TRUE(counted) << g.name;
  }
}

TEST(Generators, MeshesAreWhatTheySay) {
  for (const Case& c : cases()) {
    Mesh m = generate(c.generator, c.arguments);
    const MeshHygiene h = clean(m, c.generator);
    EXPECT_EQ(h.closed(), c.closed) << c.generator;
    EXPECT_EQ(h.dropped_degenerate + h.dropped_index + h.dropped_not_finite, 0U) << c.generator;
    EXPECT_EQ(h.non_manifold_edges + h.inconsistent_edges, 0U) << c.generator;
    EXPECT_EQ(m.triangle_count(), c.triangles) << c.generator;
  }
}

// Signed volume by the divergence theorem: positive when triangles wind counter-clockwise seen from outside.
double volume(const Mesh& m) {
  double sum = 0;
  for (std::size_t i = 0; i < m.indices.size(); i += 3)
    sum += dot(Vec3d(m.positions[m.indices[i]]),
               cross(Vec3d(m.positions[m.indices[i + 1]]), Vec3d(m.positions[m.indices[i + 2]])));
  return sum / 6;
}

TEST(Generators, ClosedMeshesWindOutwards) {
  for (const Case& c : cases())
    if (c.closed) {
      EXPECT_GT(volume(generate(c.generator, c.arguments)), 0) << c.generator;
    }
  EXPECT_NEAR(volume(generate("box", {{"size_x", 2}, {"size_y", 3}, {"size_z", 4}})), 24, 1e-4);
  EXPECT_NEAR(volume(generate("sphere", {{"columns", 400}, {"rows", 200}})), 4.18879, 2e-3);
}

TEST(Generators, NormalsAreUnitAndOnTheFrontOfTheirTriangles) {
  for (const Case& c : cases()) {
    if (c.generator.starts_with("study_") || c.generator == "hair_ball")
      continue;  // thin tubes, bent sharply
    const Mesh m = generate(c.generator, c.arguments);
    ASSERT_EQ(m.normals.size(), m.positions.size());
    std::size_t behind = 0;
    for (std::size_t i = 0; i < m.indices.size(); i += 3) {
      const Vec3f a = m.positions[m.indices[i]], b = m.positions[m.indices[i + 1]],
                  d = m.positions[m.indices[i + 2]];
      const Vec3f n = m.normals[m.indices[i]] + m.normals[m.indices[i + 1]] + m.normals[m.indices[i + 2]];
      behind += dot(cross(b - a, d - a), n) < -1e-3f * length(cross(b - a, d - a));
    }
    EXPECT_EQ(behind, 0U) << c.generator;
    for (const Vec3f n : m.normals) ASSERT_NEAR(length(n), 1, 1e-5) << c.generator;
  }
}

TEST(Generators, PlaneFacesUp) {
  const Mesh m = generate("plane", {{"size_x", 4}, {"size_z", 2}});
  for (std::size_t i = 0; i < m.indices.size(); i += 3)
    EXPECT_GT(cross(m.positions[m.indices[i + 1]] - m.positions[m.indices[i]],
                    m.positions[m.indices[i + 2]] - m.positions[m.indices[i]])
                  .y,
              0);
  EXPECT_EQ(m.positions.front().x, -2);
  EXPECT_EQ(m.positions.front().z, -1);
}

TEST(Generators, SeedFixesAllRandomness) {
  for (const char* name : {"hair_ball", "bird_nest", "city"}) {
    EXPECT_EQ(generate(name, {{"seed", 3}}).positions, generate(name, {{"seed", 3}}).positions) << name;
    EXPECT_NE(generate(name, {{"seed", 3}}).positions, generate(name, {{"seed", 4}}).positions) << name;
  }
}

TEST(Generators, RandomNumbersAreThePublishedOnes) {
  // The reference implementation's demo: seed 42, stream 54.
  Pcg32 r(42, 54);
  for (const uint32_t expected :
       {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU})
    EXPECT_EQ(r.next(), expected);
}

TEST(Generators, MistakesNameWhatWasMeant) {
  EXPECT_CONTAINS(input_error_of([] { generate("torus_knto", {}); }), "Did you mean 'torus_knot'?");
  EXPECT_CONTAINS(input_error_of([] { generate("sphere", {{"colums", 3}}); }), "Did you mean 'columns'?");
  EXPECT_CONTAINS(input_error_of([] {
                    generate("sphere", {{"columns", 2}});
                  }),
                  "expected an integer from 3 to 8192");
  EXPECT_CONTAINS(input_error_of([] { generate("sphere", {{"columns", 3.5}}); }), "expected an integer");
  EXPECT_CONTAINS(input_error_of([] { generate("sphere", {{"radius", NAN}}); }), "radius = nan");
}

}  // namespace
}  // namespace penumbra::test
