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

// Means of the sets that `pixels` pixels, or the first `sets` sets of a jitter, have: of x and of x^2.
struct Moments {
  double mean = 0, square = 0;
  void add(const Vec4f& p, double weight) {
    mean += weight * double(p.x), square += weight * double(p.x) * double(p.x);
  }
};

TEST(LightRotation, MovesARegularGridWithinItsCells) {
  LightSampleRequest request{.width = 4, .height = 2};
  const LightSamples plain = make_light_samples(unit_square(), request);
  request.rotation = LightRotation::per_pixel;
  const LightSamples s = make_light_samples(unit_square(), request);
  EXPECT_EQ(s.points, plain.points);
  EXPECT_EQ(s.move, PixelMove::shift);
  Moments m;
  std::set<float> different;
  for (std::size_t pixel = 0; pixel < 4096; ++pixel)
    for (std::size_t i = 0; i < 8; ++i) {
      const Vec4f p = s.at(i, s.draw(pixel)), c = plain.points[i];
      EXPECT_LE(std::abs(p.x - c.x), 0.125001f);
      EXPECT_LE(std::abs(p.y - c.y), 0.250001f);
      m.add(p, 1 / (8 * 4096.0));
      if (i == 0) different.insert(p.x);
    }
  EXPECT_GT(different.size(), 4000U);
  EXPECT_NEAR(m.mean, 0.5, 0.002);
  EXPECT_NEAR(m.square, 1.0 / 3, 0.002);
  EXPECT_NEAR(s.bounds().hi.x, 1, 1e-6);
  EXPECT_NEAR(s.bounds().lo.y, 0, 1e-6);
}

TEST(LightRotation, WrapsOtherSetsAroundTheRectangle) {
  LightSampleRequest request{.count = 13};
  request.rotation = LightRotation::per_pixel;
  const LightSamples s = make_light_samples(unit_square(), request);
  EXPECT_EQ(s.move, PixelMove::wrap);
  std::vector<Vec4f> storage;
  Moments m;
  for (std::size_t pixel = 0; pixel < 4096; ++pixel)
    for (const Vec4f& p : s.of_pixel(pixel, storage)) {
      EXPECT_TRUE(p.x > -1e-6f && p.x < 1.000001f && p.y > -1e-6f && p.y < 1.000001f) << p.x << ' ' << p.y;
      m.add(p, 1 / (13 * 4096.0));
    }
  EXPECT_NEAR(m.mean, 0.5, 0.002);
  EXPECT_NEAR(m.square, 1.0 / 3, 0.002);
}

TEST(LightRotation, TurnsASphereAboutItsVerticalAxis) {
  Light light;
  light.kind = LightKind::sphere, light.radius = 2, light.center = {1, 2, 3};
  LightSampleRequest request{.width = 8, .height = 8};
  request.rotation = LightRotation::per_pixel;
  const LightSamples s = make_light_samples(light, request);
  EXPECT_EQ(s.move, PixelMove::turn);
  double mean_cosine = 0;
  for (std::size_t pixel = 0; pixel < 4096; ++pixel) {
    const Vec2f drawn = s.draw(pixel);
    EXPECT_NEAR(drawn.x * drawn.x + drawn.y * drawn.y, 1, 1e-6);
    mean_cosine += double(drawn.x) / 4096;
    const Vec4f p = s.at(5, drawn), c = s.points[5];
    EXPECT_EQ(p.y, c.y);
    EXPECT_NEAR(length(p.xyz() - light.center), length(c.xyz() - light.center), 1e-5);
  }
  EXPECT_NEAR(mean_cosine, 0, 0.03);
}

TEST(LightRotation, IsNotForLightsWithoutSymmetry) {
  Light light = unit_square();
  EXPECT_FALSE(why_not_rotated(light));
  light.kind = LightKind::volume;
  EXPECT_TRUE(why_not_rotated(light));
  EXPECT_TRUE(why_not_jittered(light));
  light.kind = LightKind::textured_rectangle;
  EXPECT_TRUE(why_not_rotated(light));
  EXPECT_FALSE(why_not_jittered(light));
}

// 64 sets of 16 samples fill the light far better than one set does.
TEST(LightJitter, SetsFillTheLightTogether) {
  for (const LightPattern pattern : {LightPattern::regular, LightPattern::jittered, LightPattern::halton})
    for (const int count : {0, 16}) {
      std::set<std::pair<float, float>> seen;
      Moments m;
      for (int set = 0; set < 64; ++set) {
        LightSampleRequest request{.width = 4, .height = 4, .count = count, .pattern = pattern};
        request.set = set;
        const LightSamples s = make_light_samples(unit_square(), request);
        for (const Vec4f& p : s.points) {
          EXPECT_TRUE(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1);
          seen.insert({p.x, p.y});
          m.add(p, 1 / 1024.0);
        }
      }
      EXPECT_EQ(seen.size(), 1024U);
      EXPECT_NEAR(m.mean, 0.5, 0.004);
      EXPECT_NEAR(m.square, 1.0 / 3, 0.004);
    }
}

TEST(LightJitter, SetsOfARegularGridAreTheGridMovedAndTheFirstIsItself) {
  LightSampleRequest request{.width = 4, .height = 4};
  const LightSamples plain = make_light_samples(unit_square(), request);
  EXPECT_EQ(plain.grid_shift, (Vec2f{0, 0}));
  request.set = 5;
  const LightSamples s = make_light_samples(unit_square(), request);
  EXPECT_EQ(s.width, 4);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(s.points[i].x - plain.points[i].x, s.grid_shift.x / 4, 1e-6f);
    EXPECT_NEAR(s.points[i].y - plain.points[i].y, s.grid_shift.y / 4, 1e-6f);
  }
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
