#include "reference/reference.h"

#include <gtest/gtest.h>

#include <bit>

#include "tests/support/analytic.h"
#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"

namespace penumbra {
namespace {

using testing::BruteForce;
using testing::Differences;
using testing::HostView;

// Ground, a soup of triangles over it and sky behind.
struct SoupScene {
  Geometry geometry;
  HostView view;
  Light light = testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F);

  SoupScene() {
    testing::add_ground(geometry, 2);
    testing::add_soup(geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, 150, 0.15F, 5);
    Camera camera;
    camera.eye = {0, 1.5F, 3.5F}, camera.target = {0, 0.6F, 0};
    view = testing::see(geometry, camera, 45, 35);
  }
};

void expect_only_ties(const SoupScene& scene, const Light& light, const LightSamples& samples,
                      ReferenceOrigin origin) {
  const ReferenceScene reference(scene.geometry);
  const MatchedReference matched = reference.matched(scene.view.host(), light, samples, origin);
  const BruteForce oracle(scene.geometry);
  const bool exact = origin == ReferenceOrigin::exact;
  const auto truth = testing::brute_force_mask(oracle, light, samples, scene.view.host(), exact);
  const Differences d = testing::explain_differences(oracle, light, samples, scene.view.host(), matched.mask,
                                                     truth, matched.evaluated, exact);
  EXPECT_EQ(d.unexplained, 0U) << "worst is " << d.worst << " tolerances from a tie";
  EXPECT_LE(d.differing, d.bits / 10000);
  uint64_t blocked = 0;
  for (const uint32_t word : truth) blocked += static_cast<uint64_t>(std::popcount(word));
  EXPECT_GT(blocked, d.bits / 100);
  EXPECT_GT(d.bits, 500U);
}

TEST(Matched, AgreesWithDoublePrecisionFromTheOffsetOrigin) {
  const SoupScene scene;
  expect_only_ties(scene, scene.light, testing::regular_samples(scene.light, 8, 8), ReferenceOrigin::offset);
  expect_only_ties(scene, scene.light, testing::regular_samples(scene.light, 7, 5), ReferenceOrigin::offset);
}

TEST(Matched, AgreesWithDoublePrecisionFromTheExactOrigin) {
  const SoupScene scene;
  expect_only_ties(scene, scene.light, testing::regular_samples(scene.light, 8, 8), ReferenceOrigin::exact);
}

TEST(Matched, AgreesWithDoublePrecisionForLightsOfOneSample) {
  const SoupScene scene;
  Light light = scene.light;
  for (const LightKind kind : {LightKind::point, LightKind::directional, LightKind::spot}) {
    light.kind = kind, light.cone_degrees = 12;
    for (const auto origin : {ReferenceOrigin::offset, ReferenceOrigin::exact})
      expect_only_ties(scene, light, testing::single_sample(light), origin);
  }
}

// One view sample on a triangle's plane; what the exact origin leaves out is that triangle and no other.
TEST(Matched, ExactLeavesOutTheOwnTriangleOnly) {
  Geometry geometry;
  testing::add_triangle(geometry, {-1, 0, -1}, {1, 0, -1}, {0, 0, 2});  // its own
  testing::add_triangle(geometry, {-1, 0.5F, -1}, {0, 0.5F, 2}, {1, 0.5F, -1});
  const uint32_t own[] = {0, 1};
  const Vec2f barycentrics[2] = {};
  // A little below its own triangle, as rounding may leave it.
  const Vec4f position[] = {{0, -1e-7F, 0, 1}, {0, -1e-7F, 0, 1}}, normal[] = {{0, 1, 0, 0}, {0, 1, 0, 0}};
  const ViewSamplesHost view{2, 1, own, barycentrics, position, position, normal, normal};
  Light light;
  light.center = {0, 0.25F, 0};
  const ReferenceScene reference(geometry);
  const auto below_the_second =
      reference.matched(view, light, testing::single_sample(light), ReferenceOrigin::exact);
  EXPECT_EQ(below_the_second.mask, (std::vector<uint32_t>{0, 1}));
  light.center = {0, 1, 0};
  const auto above = reference.matched(view, light, testing::single_sample(light), ReferenceOrigin::exact);
  EXPECT_EQ(above.mask, (std::vector<uint32_t>{1, 1}));
}

TEST(Matched, EvaluatesViewSamplesWithALightSampleAboveTheirHorizon) {
  const SoupScene scene;
  const LightSamples samples = testing::regular_samples(scene.light, 3, 3);
  const MatchedReference m = ReferenceScene(scene.geometry)
                                 .matched(scene.view.host(), scene.light, samples, ReferenceOrigin::offset);
  int evaluated = 0, below = 0;
  for (std::size_t i = 0; i < m.evaluated.size(); ++i) {
    bool above = false;
    for (const Vec4f& l : samples.points)
      above = above || dot(Vec3d(scene.view.geometric_normal[i].xyz()),
                           Vec3d(l.xyz()) - Vec3d(scene.view.position[i].xyz())) > 0;
    const bool sees = scene.view.triangle[i] != no_triangle;
    ASSERT_EQ(m.evaluated[i] != 0, sees && above) << i;
    if (m.evaluated[i])
      ASSERT_EQ(m.visibility[i], static_cast<float>(9 - std::popcount(m.mask[i])) / 9.0F) << i;
    else
      ASSERT_EQ(m.visibility[i], 1) << i;
    evaluated += m.evaluated[i], below += sees && !above;
  }
  EXPECT_GT(evaluated, 100);
  EXPECT_GT(below, 10);
}

TEST(Matched, ARectangleSeenFromBehindIsEvaluatedAndDark) {
  const SoupScene scene;
  Light turned = scene.light;
  turned.direction = -turned.direction;
  std::swap(turned.edge_u, turned.edge_v);
  const MatchedReference m = ReferenceScene(scene.geometry)
                                 .matched(scene.view.host(), turned, testing::regular_samples(turned, 3, 3),
                                          ReferenceOrigin::offset);
  int evaluated = 0;
  for (std::size_t i = 0; i < m.evaluated.size(); ++i) {
    evaluated += m.evaluated[i];
    ASSERT_EQ(m.visibility[i], m.evaluated[i] ? 0.0F : 1.0F);
  }
  EXPECT_GT(evaluated, 100);
}

TEST(Matched, OfASceneWithoutTrianglesIsAllLight) {
  const SoupScene scene;
  const MatchedReference m =
      ReferenceScene(Geometry{})
          .matched(scene.view.host(), scene.light, testing::regular_samples(scene.light, 1, 1),
                   ReferenceOrigin::offset);
  for (std::size_t i = 0; i < m.evaluated.size(); ++i) ASSERT_EQ(m.visibility[i], 1);
}

// A box over the ground, whose shadow is known in closed form.
struct BoxScene {
  Vec3d lo{-0.3, 0.4, -0.25}, hi{0.35, 0.9, 0.3};
  Geometry geometry;
  HostView view;
  Light light = testing::rectangle_light({0.6F, 3, 0.4F}, {0, 0, 0}, 0.9F, 0.7F);

  BoxScene() {
    testing::add_ground(geometry, 2);
    testing::add_box(geometry, Vec3f(lo), Vec3f(hi));
    Camera camera;
    camera.eye = {0.2F, 2.2F, 2}, camera.target = {0, 0.2F, 0};
    view = testing::see(geometry, camera, 48, 36);
  }
  double exact(std::size_t pixel) const {
    const Vec3d position(view.origin[pixel].xyz());
    return testing::rectangle_visibility(light, position, {0, 1, 0},
                                         testing::faces_towards(position, lo, hi));
  }
};

TEST(Converged, AgreesWithTheClosedFormWithinItsOwnStandardError) {
  const BoxScene scene;
  const auto c = ReferenceScene(scene.geometry)
                     .converged(scene.view.host(), scene.light, 1024, 1, ReferenceOrigin::offset, {});
  double squares = 0, claimed = 0, sum = 0;
  int penumbra = 0, ground = 0;
  for (std::size_t i = 0; i < scene.view.triangle.size(); ++i) {
    if (scene.view.triangle[i] > 1) continue;
    ASSERT_TRUE(c.evaluated[i]);
    const double exact = scene.exact(i), error = static_cast<double>(c.visibility[i]) - exact;
    ++ground, sum += error;
    if (exact == 0 || exact == 1) {
      ASSERT_LT(std::abs(error), 0.01) << "pixel " << i;
      continue;
    }
    squares += error * error, claimed += std::pow(static_cast<double>(c.standard_error[i]), 2), ++penumbra;
  }
  ASSERT_GT(penumbra, 100);
  const double rms = std::sqrt(squares / penumbra), rms_claimed = std::sqrt(claimed / penumbra);
  EXPECT_LT(rms, 0.01);
  EXPECT_GT(rms / rms_claimed, 0.5) << rms << " against the claimed " << rms_claimed;
  EXPECT_LT(rms / rms_claimed, 1.6) << rms << " against the claimed " << rms_claimed;
  EXPECT_LT(std::abs(sum / ground), 1e-3);
  EXPECT_FALSE(c.from_cache);
  EXPECT_GT(c.mean_standard_error, 0);
}

TEST(Converged, ErrsLessWithMoreSamples) {
  const BoxScene scene;
  const ReferenceScene reference(scene.geometry);
  const auto few = reference.converged(scene.view.host(), scene.light, 64, 1, ReferenceOrigin::offset, {});
  const auto many = reference.converged(scene.view.host(), scene.light, 2048, 1, ReferenceOrigin::offset, {});
  EXPECT_LT(many.mean_standard_error, few.mean_standard_error / 5);
}

TEST(Converged, IsTheSameEachTimeAndAnotherForAnotherSeed) {
  const BoxScene scene;
  const ReferenceScene reference(scene.geometry);
  const auto a = reference.converged(scene.view.host(), scene.light, 100, 1, ReferenceOrigin::offset, {});
  const auto b = reference.converged(scene.view.host(), scene.light, 100, 1, ReferenceOrigin::offset, {});
  const auto c = reference.converged(scene.view.host(), scene.light, 100, 2, ReferenceOrigin::offset, {});
  EXPECT_EQ(a.visibility, b.visibility);
  EXPECT_EQ(a.standard_error, b.standard_error);
  EXPECT_NE(a.visibility, c.visibility);
}

TEST(Converged, OfAPointLightIsTheMatchedReference) {
  const BoxScene scene;
  Light light = scene.light;
  light.kind = LightKind::point;
  const ReferenceScene reference(scene.geometry);
  const auto c = reference.converged(scene.view.host(), light, 4096, 1, ReferenceOrigin::exact, {});
  const auto m =
      reference.matched(scene.view.host(), light, testing::single_sample(light), ReferenceOrigin::exact);
  EXPECT_EQ(c.visibility, m.visibility);
  EXPECT_EQ(c.evaluated, m.evaluated);
  EXPECT_EQ(c.mean_standard_error, 0);
}

// The disc has a closed form; the ball, which most techniques sample, is another light.
TEST(Converged, OfASphereTakenAsTheDiscThatFacesTheViewSampleAgreesWithTheClosedForm) {
  const BoxScene scene;
  Light light = scene.light;
  light.kind = LightKind::sphere, light.radius = 0.5F;
  const ReferenceScene reference(scene.geometry);
  const auto rms_error = [&](SphereAs sphere) {
    const auto c =
        reference.converged(scene.view.host(), light, 1024, 1, ReferenceOrigin::offset, {}, sphere);
    double squares = 0;
    int penumbra = 0;
    for (std::size_t i = 0; i < scene.view.triangle.size(); ++i) {
      if (scene.view.triangle[i] > 1) continue;
      const Vec3d p(scene.view.origin[i].xyz());
      const double exact = testing::disc_visibility(Vec3d(light.center), double(light.radius), p, {0, 1, 0},
                                                    testing::faces_towards(p, scene.lo, scene.hi));
      if (exact > 0 && exact < 1) squares += std::pow(double(c.visibility[i]) - exact, 2), ++penumbra;
    }
    EXPECT_GT(penumbra, 100);
    return std::sqrt(squares / penumbra);
  };
  EXPECT_LT(rms_error(SphereAs::disc), 0.005);
  EXPECT_GT(rms_error(SphereAs::ball), 0.02);
}

// Each pixel's own set, against double precision.
TEST(Matched, TakesTheSamplesThatEachPixelMoves) {
  const SoupScene scene;
  LightSampleRequest request{8, 8};
  request.rotation = LightRotation::per_pixel;
  expect_only_ties(scene, scene.light, make_light_samples(scene.light, request), ReferenceOrigin::offset);
}

TEST(Converged, TakesASingleSample) {
  const BoxScene scene;
  const auto c = ReferenceScene(scene.geometry)
                     .converged(scene.view.host(), scene.light, 1, 1, ReferenceOrigin::offset, {});
  for (const float v : c.visibility) ASSERT_TRUE(v == 0 || v == 1);
}

}  // namespace
}  // namespace penumbra
