// ray_tracing's hierarchy and loops against double precision and closed forms. They need no device; the room
// as a whole, behind the technique contract, is tested with all others.
#include <gtest/gtest.h>

#include <bit>
#include <memory>

#include "techniques/common/embree_hierarchy.h"
#include "techniques/ray_tracing/tracer.h"
#include "tests/support/allocation_count.h"
#include "tests/support/analytic.h"
#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"

namespace penumbra::ray_tracing {
namespace {

using Hierarchy = EmbreeHierarchy;
using Quality = HierarchyQuality;
using testing::BruteForce;
using testing::Differences;
using testing::HostView;

std::unique_ptr<Hierarchy> build(const Geometry& geometry, Quality quality = Quality::high,
                                 bool robust = false) {
  auto hierarchy = std::make_unique<Hierarchy>(quality, quality != Quality::high, robust);
  hierarchy->load(geometry);
  hierarchy->commit();
  return hierarchy;
}

struct Picture {
  std::vector<float> visibility;
  std::vector<uint32_t> mask;
  TraceCounts counts;
};

Picture trace(const Hierarchy& hierarchy, const HostView& view, const Light& light,
              const LightSamples& samples, const TraceSettings& settings = {}) {
  Tracer tracer;
  tracer.assign(light, samples, settings);
  const std::size_t pixels = view.triangle.size();
  // Rubbish at first, so that a pixel that is not written shows.
  Picture p{std::vector<float>(pixels, -7.0F), {}, {}};
  p.mask.assign(pixels * static_cast<std::size_t>(samples.mask_words()), 0xdeadbeefU);
  p.counts = tracer.trace(hierarchy.scene(), view.host(), p.visibility, p.mask);
  return p;
}

// Ground, a soup of triangles over it and sky behind; 45 x 35 pixels, no multiple of a tile.
struct SoupScene {
  Geometry geometry;
  HostView view;
  Light light = testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F);

  explicit SoupScene(uint32_t seed = 3) {
    testing::add_ground(geometry, 2);
    testing::add_soup(geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, 150, 0.15F, seed);
    Camera camera;
    camera.eye = {0, 1.5F, 3.5F}, camera.target = {0, 0.6F, 0};
    view = testing::see(geometry, camera, 45, 35);
  }
};

void expect_only_ties(const SoupScene& scene, const Light& light, const LightSamples& samples,
                      const Picture& picture) {
  const BruteForce oracle(scene.geometry);
  const std::vector<uint32_t> truth = testing::brute_force_mask(oracle, light, samples, scene.view.host());
  const Differences d =
      testing::explain_differences(oracle, light, samples, scene.view.host(), picture.mask, truth, {});
  EXPECT_EQ(d.unexplained, 0U) << "worst is " << d.worst << " tolerances from a tie";
  EXPECT_LE(d.differing, d.bits / 10000);
  uint64_t blocked = 0;
  for (const uint32_t word : truth) blocked += static_cast<uint64_t>(std::popcount(word));
  EXPECT_GT(blocked, d.bits / 100) << "the scene shows no shadow";
  EXPECT_LT(blocked, d.bits) << "the scene shows no light";
}

TEST(RayTracingScene, ShowsSkyGroundAndSoup) {
  const SoupScene scene;
  int sky = 0, ground = 0, soup = 0;
  for (const uint32_t t : scene.view.triangle) ++(t == no_triangle ? sky : t < 2 ? ground : soup);
  EXPECT_GT(sky, 50);
  EXPECT_GT(ground, 50);
  EXPECT_GT(soup, 50);
}

class Loops : public ::testing::TestWithParam<std::tuple<int, bool, embree::Coherence>> {
 protected:
  TraceSettings settings() const {
    return {std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam())};
  }
};
INSTANTIATE_TEST_SUITE_P(All, Loops,
                         ::testing::Combine(::testing::Values(1, 4, 8, 16), ::testing::Bool(),
                                            ::testing::Values(embree::Coherence::coherent,
                                                              embree::Coherence::incoherent)));

TEST_P(Loops, GiveTheMaskOfDoublePrecision) {
  const SoupScene scene;
  const LightSamples samples = testing::regular_samples(scene.light, 8, 8);
  expect_only_ties(scene, scene.light, samples,
                   trace(*build(scene.geometry), scene.view, scene.light, samples, settings()));
}

TEST_P(Loops, TakeAnyCountOfSamplesAndAnyGrid) {
  const SoupScene scene;
  const auto hierarchy = build(scene.geometry);
  for (const auto& [w, h] : {std::pair{10, 7}, {3, 1}, {5, 13}}) {
    const LightSamples grid = testing::regular_samples(scene.light, w, h);
    expect_only_ties(scene, scene.light, grid, trace(*hierarchy, scene.view, scene.light, grid, settings()));
  }
  LightSamples no_grid = testing::regular_samples(scene.light, 37, 1);
  no_grid.width = no_grid.height = 0;
  for (std::size_t i = 0; i < no_grid.points.size(); ++i)
    std::swap(no_grid.points[i], no_grid.points[i * 7 % 37]);
  expect_only_ties(scene, scene.light, no_grid,
                   trace(*hierarchy, scene.view, scene.light, no_grid, settings()));
}

TEST_P(Loops, TakeLightsOfOneSample) {
  const SoupScene scene;
  const auto hierarchy = build(scene.geometry);
  Light light = scene.light;
  for (const LightKind kind : {LightKind::point, LightKind::directional, LightKind::spot}) {
    light.kind = kind, light.cone_degrees = 15;
    const LightSamples samples = testing::single_sample(light);
    expect_only_ties(scene, light, samples, trace(*hierarchy, scene.view, light, samples, settings()));
  }
}

TEST_P(Loops, CountEveryLightSampleOnce) {
  const SoupScene scene;
  const LightSamples samples = testing::regular_samples(scene.light, 6, 6);
  const Picture p = trace(*build(scene.geometry), scene.view, scene.light, samples, settings());
  uint64_t seen = 0;
  for (const uint32_t t : scene.view.triangle) seen += t != no_triangle;
  EXPECT_EQ(p.counts.rays + p.counts.without_ray, seen * 36);
  EXPECT_GT(p.counts.without_ray, 0U);
  EXPECT_GT(p.counts.rays, p.counts.without_ray);
}

TEST(RayTracing, RobustModeAgreesWithDoublePrecisionToo) {
  const SoupScene scene(8);
  const LightSamples samples = testing::regular_samples(scene.light, 8, 8);
  expect_only_ties(scene, scene.light, samples,
                   trace(*build(scene.geometry, Quality::high, true), scene.view, scene.light, samples));
}

TEST(RayTracing, WritesVisibilityFromTheMaskAndNothingPastTheCount) {
  const SoupScene scene;
  LightSamples samples = testing::regular_samples(scene.light, 5, 7);
  const Picture p = trace(*build(scene.geometry), scene.view, scene.light, samples);
  ASSERT_EQ(samples.mask_words(), 2);
  for (std::size_t pixel = 0; pixel < scene.view.triangle.size(); ++pixel) {
    const uint32_t low = p.mask[2 * pixel], high = p.mask[2 * pixel + 1];
    ASSERT_EQ(high >> 3, 0U) << pixel;
    const int blocked = std::popcount(low) + std::popcount(high);
    ASSERT_EQ(p.visibility[pixel], static_cast<float>(35 - blocked) / 35.0F) << pixel;
    if (scene.view.triangle[pixel] == no_triangle) {
      ASSERT_EQ(blocked, 0) << pixel;
    }
  }
}

TEST(RayTracing, WeighsTheSamplesOfATexturedLight) {
  const SoupScene scene;
  LightSamples samples = testing::regular_samples(scene.light, 2, 1);
  samples.uniform_weights = false;
  samples.weights = {0.25F, 0.75F};
  const Picture p = trace(*build(scene.geometry), scene.view, scene.light, samples);
  constexpr float expected[4] = {1.0F, 0.75F, 0.25F, 0.0F};
  for (std::size_t pixel = 0; pixel < p.mask.size(); ++pixel)
    ASSERT_EQ(p.visibility[pixel], expected[p.mask[pixel]]);
}

TEST(RayTracing, ARectangleBehindItsFrontBlocksEverything) {
  const SoupScene scene;
  Light turned = scene.light;
  turned.direction = -turned.direction;
  std::swap(turned.edge_u, turned.edge_v);
  const LightSamples samples = testing::regular_samples(turned, 4, 4);
  const Picture p = trace(*build(scene.geometry), scene.view, turned, samples);
  EXPECT_EQ(p.counts.rays, 0U);
  for (std::size_t pixel = 0; pixel < p.mask.size(); ++pixel)
    ASSERT_EQ(p.mask[pixel], scene.view.triangle[pixel] == no_triangle ? 0U : 0xffffU);
}

TEST(RayTracing, ALightSampleInTheReceiversPlaneIsBlocked) {
  Geometry geometry;
  testing::add_ground(geometry, 1);
  Camera camera;
  camera.eye = {0, 2, 0.1F}, camera.target = {0, 0, 0};
  const HostView view = testing::see(geometry, camera, 8, 8);
  Light light;
  light.center = {0.5F, 0, 0.5F};
  const Picture p = trace(*build(geometry), view, light, testing::single_sample(light));
  EXPECT_EQ(p.counts.rays, 0U);
  for (std::size_t pixel = 0; pixel < p.mask.size(); ++pixel) ASSERT_EQ(p.mask[pixel], 1U) << pixel;
}

class DynamicQualities : public ::testing::TestWithParam<Quality> {};
INSTANTIATE_TEST_SUITE_P(All, DynamicQualities,
                         ::testing::Values(Quality::low, Quality::medium, Quality::high, Quality::refit));

TEST_P(DynamicQualities, FollowTheVertices) {
  SoupScene scene;
  Hierarchy hierarchy(GetParam(), true, false);
  hierarchy.load(scene.geometry);
  hierarchy.commit();
  for (int frame = 0; frame < 3; ++frame) {
    for (std::size_t v = 6; v < scene.geometry.positions.size(); ++v) {
      Vec3f& p = scene.geometry.positions[v];
      p = {p.x + 0.1F * p.y, p.y, p.z - 0.05F};
    }
    ASSERT_TRUE(hierarchy.fits(scene.geometry));
    hierarchy.move(scene.geometry);
    hierarchy.commit();
    Camera camera;
    camera.eye = {0, 1.5F, 3.5F}, camera.target = {0, 0.6F, 0};
    scene.view = testing::see(scene.geometry, camera, 30, 20);
    const LightSamples samples = testing::regular_samples(scene.light, 4, 4);
    expect_only_ties(scene, scene.light, samples, trace(hierarchy, scene.view, scene.light, samples));
  }
}

TEST(Hierarchy, CountsItsBytesAndGivesThemBack) {
  const SoupScene scene;
  Hierarchy hierarchy(Quality::high, false, false);
  hierarchy.load(scene.geometry);
  hierarchy.commit();
  const uint64_t once = hierarchy.bytes();
  EXPECT_GT(once, scene.geometry.triangle_count() * 40);
  EXPECT_LT(once, uint64_t{8} << 20);
  for (int i = 0; i < 20; ++i) hierarchy.load(scene.geometry), hierarchy.commit();
  EXPECT_LE(hierarchy.bytes(), 2 * once);
}

TEST(Hierarchy, DoesNotFitAnotherTopology) {
  const SoupScene scene;
  const auto hierarchy = build(scene.geometry);
  Geometry other = scene.geometry;
  testing::add_triangle(other, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_FALSE(hierarchy->fits(other));
}

TEST(RayTracing, AllocatesNothingPerFrame) {
  const SoupScene scene;
  const auto hierarchy = build(scene.geometry);
  const LightSamples samples = testing::regular_samples(scene.light, 8, 8);
  Tracer tracer;
  tracer.assign(scene.light, samples, {});
  const ViewSamplesHost view = scene.view.host();
  std::vector<float> visibility(view.pixel_count());
  std::vector<uint32_t> mask(2 * view.pixel_count());
  tracer.trace(hierarchy->scene(), view, visibility, mask);
  // Of several frames the one with the fewest: a thread that takes part for the first time allocates its own
  // once.
  long fewest = 1000;
  for (int frame = 0; frame < 8; ++frame) {
    const long before = testing::allocation_count();
    tracer.trace(hierarchy->scene(), view, visibility, mask);
    fewest = std::min(fewest, testing::allocation_count() - before);
  }
  EXPECT_EQ(fewest, 0);
}

// A regular grid's error for a convex shadow is at most the share of its cells that the outline crosses.
TEST(RayTracing, AgreesWithTheClosedFormOfAConvexOccluderToTheSamplingError) {
  const Vec3d lo{-0.3, 0.4, -0.25}, hi{0.35, 0.9, 0.3};
  Geometry geometry;
  testing::add_ground(geometry, 2);
  testing::add_box(geometry, Vec3f(lo), Vec3f(hi));
  Camera camera;
  camera.eye = {0.2F, 2.2F, 2}, camera.target = {0, 0.2F, 0};
  const HostView view = testing::see(geometry, camera, 64, 48);
  const Light light = testing::rectangle_light({0.6F, 3, 0.4F}, {0, 0, 0}, 0.9F, 0.7F);
  const int k = 32;
  const Picture p = trace(*build(geometry), view, light, testing::regular_samples(light, k, k));
  double sum = 0;
  int pixels = 0, penumbra = 0;
  for (std::size_t i = 0; i < view.triangle.size(); ++i) {
    if (view.triangle[i] > 1) continue;  // the ground
    const Vec3d position(view.origin[i].xyz());
    const double exact =
        testing::rectangle_visibility(light, position, {0, 1, 0}, testing::faces_towards(position, lo, hi));
    const double error = static_cast<double>(p.visibility[i]) - exact;
    ASSERT_LE(std::abs(error), 2.0 * 2 * k / (k * k)) << "pixel " << i;
    sum += error, ++pixels, penumbra += exact > 0 && exact < 1;
  }
  EXPECT_GT(penumbra, 200);
  EXPECT_LT(std::abs(sum / pixels), 2e-4) << "a bias over " << pixels << " pixels";
}

}  // namespace
}  // namespace penumbra::ray_tracing
