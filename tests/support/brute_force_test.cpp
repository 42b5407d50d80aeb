#include "tests/support/brute_force.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/host_view.h"

namespace penumbra::testing {
namespace {

// The unit square in z = 1 as two triangles that share its diagonal.
Geometry square() {
  Geometry g;
  add_triangle(g, {0, 0, 1}, {1, 0, 1}, {1, 1, 1});
  add_triangle(g, {0, 0, 1}, {1, 1, 1}, {0, 1, 1});
  return g;
}

Light light_at(LightKind kind, Vec3f center) {
  Light light;
  light.kind = kind;
  light.center = center;
  return light;
}

constexpr double search = 1e-3;

Tie straight_up(const BruteForce& scene, double x, double y) {
  return scene.explain({x, y, 0}, {x, y, 2, 1}, no_triangle, search);
}

TEST(BruteForce, TreeFindsWhatExhaustionFinds) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> at(-1, 1), small(-0.2F, 0.2F);
  Geometry g;
  for (int i = 0; i < 300; ++i) {
    const Vec3f a{at(random), at(random), at(random)};
    const auto corner = [&] { return a + Vec3f{small(random), small(random), small(random)}; };
    add_triangle(g, a, corner(), corner());
  }
  const BruteForce scene(g);
  int blocked = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d o{at(random) * 2, at(random) * 2, at(random) * 2};
    const Vec4d l{at(random) * 2, at(random) * 2, at(random) * 2, i % 3 == 0 ? 0.0 : 1.0};
    const bool expected = scene.blocked_by_exhaustion(o, l);
    ASSERT_EQ(scene.blocked(o, l), expected) << i;
    blocked += expected;
  }
  EXPECT_GT(blocked, 300);
  EXPECT_LT(blocked, 2700);
}

TEST(BruteForce, OnlyPointsStrictlyBetweenTheEndsBlock) {
  const BruteForce scene(square());
  EXPECT_TRUE(scene.blocked({0.5, 0.25, 0}, {0.5, 0.25, 2, 1}));
  EXPECT_FALSE(scene.blocked({0.5, 0.25, 0}, {0.5, 0.25, 0.9, 1}));
  EXPECT_FALSE(scene.blocked({0.5, 0.25, 1}, {0.5, 0.25, 2, 1}));
  EXPECT_FALSE(scene.blocked({0.5, 0.25, 0}, {0.5, 0.25, 1, 1}));
  EXPECT_TRUE(scene.blocked({0.5, 0.25, 0}, {0, 0, 1, 0}));
  EXPECT_FALSE(scene.blocked({0.5, 0.25, 0}, {0, 0, -1, 0}));
}

TEST(BruteForce, ASharedEdgeBlocksAndOwnTriangleCanBeSkipped) {
  const BruteForce scene(square());
  EXPECT_TRUE(scene.blocked({0.5, 0.5, 0}, {0.5, 0.5, 2, 1}));
  EXPECT_FALSE(scene.blocked({0.75, 0.25, 0}, {0.75, 0.25, 2, 1}, 0));
}

TEST(Tie, AVisibleSegmentIsAsFarFromATieAsFromTheNearestTriangle) {
  const BruteForce scene(square());
  const Tie beside = straight_up(scene, 1 + 4e-4, 0.5);
  EXPECT_FALSE(beside.blocked);
  EXPECT_NEAR(beside.distance, 4e-4, 1e-12);
  EXPECT_EQ(straight_up(scene, 1.01, 0.5).distance, INFINITY);
  // Its end stops short of the plane.
  EXPECT_NEAR(scene.explain({0.5, 0.2, 0}, {0.5, 0.2, 0.9997, 1}, no_triangle, search).distance, 3e-4, 1e-12);
}

TEST(Tie, ABlockedSegmentIsATieOnlyNearTheOutline) {
  const BruteForce scene(square());
  const Tie near_border = straight_up(scene, 1 - 4e-4, 0.5);
  EXPECT_TRUE(near_border.blocked);
  EXPECT_NEAR(near_border.distance, 4e-4, 2e-6);
  // Just beside the diagonal that both triangles share: the other triangle blocks there.
  const Tie near_diagonal = straight_up(scene, 0.5, 0.5 + 1e-4);
  EXPECT_TRUE(near_diagonal.blocked);
  EXPECT_EQ(near_diagonal.distance, INFINITY);
}

TEST(Tie, ABlockedSegmentEscapesByShorteningAnEnd) {
  const BruteForce scene(square());
  EXPECT_NEAR(scene.explain({0.5, 0.2, 1 - 2e-4}, {0.5, 0.2, 2, 1}, no_triangle, search).distance, 2e-4,
              1e-9);
  EXPECT_NEAR(scene.explain({0.5, 0.2, 0}, {0.5, 0.2, 1 + 3e-4, 1}, no_triangle, search).distance, 3e-4,
              1e-9);
}

TEST(Tie, TwoLayersMustBothBeEscaped) {
  Geometry g = square();
  add_triangle(g, {-5, -5, 1.5F}, {5, -5, 1.5F}, {0, 5, 1.5F});
  const BruteForce scene(g);
  EXPECT_EQ(straight_up(scene, 1 - 4e-4, 0.5).distance, INFINITY);
}

TEST(Horizon, CountsThePlaneItselfAsBlocked) {
  const Light light = light_at(LightKind::point, {0, 0, 1});
  EXPECT_TRUE(judge_horizon(light, {0, 0, 0}, {0, 0, 1}, {1, 0, 0, 1}).blocked);
  EXPECT_TRUE(judge_horizon(light, {0, 0, 0}, {0, 0, 1}, {1, 0, -1, 0}).blocked);
  const HorizonJudgement above = judge_horizon(light, {0, 0, 0}, {0, 0, 2}, {1, 0, 0.25, 1});
  EXPECT_FALSE(above.blocked);
  EXPECT_DOUBLE_EQ(above.distance, 0.25);
}

TEST(Horizon, ARectangleShinesFromItsFrontOnly) {
  Light light = light_at(LightKind::rectangle, {0, 0, 1});
  light.direction = {0, 0, -1};
  EXPECT_FALSE(judge_horizon(light, {0, 0, 0}, {0, 0, 1}, {0, 0, 1, 1}).blocked);
  light.direction = {0, 0, 1};
  EXPECT_TRUE(judge_horizon(light, {0, 0, 0}, {0, 0, 1}, {0, 0, 1, 1}).blocked);
}

TEST(Horizon, AViewSampleOutsideTheConeIsBlocked) {
  Light light = light_at(LightKind::spot, {0, 0, 1});
  light.direction = {0, 0, -1};
  light.cone_degrees = 45;
  EXPECT_FALSE(judge_horizon(light, {0.9, 0, 0}, {0, 0, 1}, {0, 0, 1, 1}).blocked);
  EXPECT_TRUE(judge_horizon(light, {1.1, 0, 0}, {0, 0, 1}, {0, 0, 1, 1}).blocked);
}

TEST(ExplainDifferences, TellsTiesFromErrors) {
  const Geometry g = square();
  const BruteForce scene(g);
  Light light = light_at(LightKind::point, {0.5F, 0.5F, 2});
  LightSamples samples;
  samples.points = {{0.5F, 0.5F, 2, 1}};
  samples.weights = {1};
  const std::vector<uint32_t> triangle{0, 0, no_triangle};
  const std::vector<Vec2f> barycentrics(3);
  // Straight below the middle: blocked. Projected on the square's border: a tie.
  const std::vector<Vec4f> position{{0.5F, 0.4F, 0, 1}, {1.5F, 0.5F, 0, 1}, {}};
  const std::vector<Vec4f> normal(3, Vec4f{0, 0, 1, 0});
  const ViewSamplesHost view{3, 1, triangle, barycentrics, position, position, normal, normal};
  const std::vector<uint32_t> truth = brute_force_mask(scene, light, samples, view);
  EXPECT_EQ(truth, (std::vector<uint32_t>{1, 1, 0}));
  const std::vector<uint32_t> wrong_tie{1, 0, 0}, wrong{0, 1, 0};
  const Differences tie = explain_differences(scene, light, samples, view, wrong_tie, truth, {});
  EXPECT_EQ(tie.differing, 1U);
  EXPECT_EQ(tie.unexplained, 0U);
  const Differences error = explain_differences(scene, light, samples, view, wrong, truth, {});
  EXPECT_EQ(error.differing, 1U);
  EXPECT_EQ(error.unexplained, 1U);
}

}  // namespace
}  // namespace penumbra::testing
