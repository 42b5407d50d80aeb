#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "samples/light_samples.h"

namespace penumbra {
namespace {

Light unit_square() {
  Light light;
  light.kind = LightKind::rectangle;
  light.center = {0.5f, 0.5f, 0};
  light.edge_u = {1, 0, 0}, light.edge_v = {0, 1, 0}, light.direction = {0, 0, 1};
  return light;
}

TEST(LightSamples, RegularOnesAreCellCentresRowByRow) {
  const LightSamples s = make_light_samples(unit_square(), {.width = 4, .height = 2});
  ASSERT_EQ(s.count(), 8);
  EXPECT_EQ(s.width, 4);
  EXPECT_EQ(s.height, 2);
  EXPECT_EQ(s.mask_words(), 1);
  EXPECT_FLOAT_EQ(s.points[0].x, 0.125f);
  EXPECT_FLOAT_EQ(s.points[0].y, 0.25f);
  EXPECT_FLOAT_EQ(s.points[5].x, 0.375f);  // row 1, column 1
  EXPECT_FLOAT_EQ(s.points[5].y, 0.75f);
}

TEST(LightSamples, PointsSpotsAndDirectionsAreOneSample) {
  Light light;
  light.center = {1, 2, 3};
  for (LightKind kind : {LightKind::point, LightKind::spot}) {
    light.kind = kind;
    const LightSamples s = make_light_samples(light, {});
    ASSERT_EQ(s.count(), 1);
    EXPECT_EQ(s.points[0], (Vec4f{1, 2, 3, 1}));
  }
  light.kind = LightKind::directional, light.direction = {0, -1, 0};
  EXPECT_EQ(make_light_samples(light, {}).points[0], (Vec4f{0, 1, 0, 0}));
}

TEST(LightSamples, ARectangleOfNoSizeIsItsCentre) {
  const LightSamples s = make_light_samples(with_size(unit_square(), 0), {});
  ASSERT_EQ(s.count(), 1);
  EXPECT_EQ(s.points[0], (Vec4f{0.5f, 0.5f, 0, 1}));
}

TEST(LightSamples, JitteredOnesStayInTheirCells) {
  const LightSamples s =
      make_light_samples(unit_square(), {.width = 16, .height = 16, .pattern = LightPattern::jittered});
  std::set<std::pair<int, int>> cells;
  for (const Vec4f& p : s.points) cells.insert({static_cast<int>(p.x * 16), static_cast<int>(p.y * 16)});
  EXPECT_EQ(cells.size(), 256U);
}

TEST(LightSamples, AnyCountOfAnyPatternIsInsideAndDistinct) {
  for (LightPattern pattern : {LightPattern::regular, LightPattern::jittered, LightPattern::halton})
    for (int n : {1, 12, 50, 97}) {
      const LightSamples s = make_light_samples(unit_square(), {.count = n, .pattern = pattern});
      ASSERT_EQ(s.count(), n);
      std::set<std::pair<float, float>> seen;
      for (const Vec4f& p : s.points) {
        EXPECT_TRUE(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1);
        seen.insert({p.x, p.y});
      }
      EXPECT_EQ(seen.size(), static_cast<std::size_t>(n));
    }
}

TEST(LightSamples, TheSameRequestGivesTheSameSetAndAnotherSeedAnother) {
  const LightSampleRequest request{.width = 8, .height = 8, .pattern = LightPattern::jittered, .seed = 3};
  LightSampleRequest other = request;
  other.seed = 4;
  EXPECT_EQ(make_light_samples(unit_square(), request).points,
            make_light_samples(unit_square(), request).points);
  EXPECT_NE(make_light_samples(unit_square(), request).points,
            make_light_samples(unit_square(), other).points);
}

// Uniform in a ball of radius 2: the mean square distance is 3/5 r^2.
TEST(LightSamples, ASphereIsSampledUniformlyOverItsVolume) {
  Light light;
  light.kind = LightKind::sphere, light.radius = 2;
  const LightSamples s = make_reference_samples(light, 4096, 1);
  double mean_square = 0;
  for (const Vec4f& p : s.points) {
    EXPECT_LE(length(p.xyz()), 2.0001f);
    mean_square += double(dot(p.xyz(), p.xyz())) / s.count();
  }
  EXPECT_NEAR(mean_square, 0.6 * 4, 0.02);
}

TEST(LightSamples, TextureWeightsAreNormalisedAndPlaced) {
  Light light = unit_square();
  light.kind = LightKind::textured_rectangle;
  light.texture_width = 2, light.texture_height = 1, light.weights = {1, 3};
  const LightSamples s = make_light_samples(light, {.width = 4, .height = 1});
  EXPECT_FALSE(s.uniform_weights);
  EXPECT_FLOAT_EQ(s.weights[0], 0.125f);
  EXPECT_FLOAT_EQ(s.weights[3], 0.375f);
}

// 1,024 scrambled Sobol points put exactly one in each cell of any elementary 32 x 32 partition; integrating
// a half-plane must beat random sampling by far.
TEST(ReferenceSamples, AreStratifiedAndUnbiased) {
  double worst = 0;
  for (uint32_t seed = 1; seed < 9; ++seed) {
    const LightSamples s = make_reference_samples(unit_square(), 1024, seed);
    std::set<std::pair<int, int>> cells;
    double below = 0;
    for (const Vec4f& p : s.points) {
      cells.insert({static_cast<int>(p.x * 32), static_cast<int>(p.y * 32)});
      below += (p.x + 0.7f * p.y < 0.6f) / 1024.0;
    }
    EXPECT_EQ(cells.size(), 1024U);
    worst = std::max(worst, std::abs(below - 0.5 * 0.6 * 0.6 / 0.7));
  }
  EXPECT_LT(worst, 0.006);  // random sampling: one standard error is 0.0137
}

}  // namespace
}  // namespace penumbra
