// gears against double precision on small scenes: every bit that differs must be a tie, whatever the light,
// the mask's size, the assignment and the order of the work.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"
#include "tests/techniques/gears_render.h"

namespace penumbra {
namespace {

using testing::BruteForce;
using testing::DeviceScene;
using testing::GearsPicture;
using testing::GearsRun;

gpu::Device& device() {
  static gpu::Device d{gpu::DeviceOptions{}};
  return d;
}

std::vector<std::string> messages() { return device().validation_messages(); }

Camera camera_at(Vec3f eye, Vec3f target) {
  Camera c;
  c.eye = eye;
  c.target = target;
  return c;
}

// Ground, a soup of triangles over it, sky behind.
Frame soup(int count = 150, float size = 0.15f, uint32_t seed = 3) {
  Frame f;
  testing::add_ground(f.geometry, 2);
  testing::add_soup(f.geometry, {-0.8f, 0.1f, -0.8f}, {0.8f, 1, 0.8f}, count, size, seed);
  f.light = testing::rectangle_light({1.5f, 3, -1}, {0, 0, 0}, 0.8f, 0.5f);
  f.camera = camera_at({0, 1.5f, 3.5f}, {0, 0.6f, 0});
  return f;
}

GearsPicture render(DeviceScene& scene, const ParamValues& params) {
  GearsRun run(scene, params);
  run.render();
  return run.picture();
}

// Pixels that have a view sample: the others may hold anything.
std::vector<uint8_t> with_view_sample(const DeviceScene& scene) {
  std::vector<uint8_t> evaluated;
  for (const uint32_t t : scene.view->host().triangle) evaluated.push_back(t != no_triangle);
  return evaluated;
}

void expect_only_ties(DeviceScene& scene, const GearsPicture& picture) {
  const BruteForce oracle(scene.frame.geometry);
  const auto truth = testing::brute_force_mask(oracle, scene.frame.light, scene.samples, scene.view->host());
  const auto d = testing::explain_differences(oracle, scene.frame.light, scene.samples, scene.view->host(),
                                              picture.mask, truth, with_view_sample(scene));
  EXPECT_EQ(d.unexplained, 0U) << d.differing << " differ; the worst is " << d.worst
                               << " tolerances from a tie";
  EXPECT_LE(d.differing, d.bits / 2000);
  EXPECT_GT(std::accumulate(truth.begin(), truth.end(), uint64_t{0}), 0U) << "the scene shows no shadow";
  EXPECT_EQ(messages(), std::vector<std::string>{});
}

// Visibility is the share (or weight) of clear bits, and no bit past the last light sample is set.
void expect_consistent(const DeviceScene& scene, const GearsPicture& picture) {
  const std::size_t words = static_cast<std::size_t>(scene.samples.mask_words());
  for (std::size_t pixel = 0; pixel < picture.visibility.size(); ++pixel) {
    if (scene.view->host().triangle[pixel] == no_triangle) continue;
    float seen = 0;
    for (int i = 0; i < scene.samples.count(); ++i)
      if ((picture.mask[pixel * words + static_cast<std::size_t>(i) / 32] >> (i % 32) & 1U) == 0)
        seen += scene.samples.weights[static_cast<std::size_t>(i)];
    ASSERT_NEAR(picture.visibility[pixel], seen, 2e-5) << pixel;
    if (scene.samples.count() % 32 != 0) {
      ASSERT_EQ(picture.mask[(pixel + 1) * words - 1] >> (scene.samples.count() % 32), 0U) << pixel;
    }
  }
}

const std::string assignments[] = {"clusters", "triangles"};

// An assignment, and behind it the backend where it is not the default one.
class GearsAssignment : public ::testing::TestWithParam<std::string> {
 protected:
  ParamValues with(ParamValues more = {}) const {
    const std::string which = GetParam();
    more["assignment"] = which.substr(0, which.find('_'));
    if (which.ends_with("_cpu")) more["backend"] = std::string("cpu");
    return more;
  }
};
INSTANTIATE_TEST_SUITE_P(Each, GearsAssignment,
                         ::testing::Values("clusters", "triangles", "clusters_cpu", "triangles_cpu"));
// What only a device can get wrong.
class GearsOnDevice : public GearsAssignment {};
INSTANTIATE_TEST_SUITE_P(Each, GearsOnDevice, ::testing::ValuesIn(assignments));

TEST_P(GearsAssignment, DiffersFromDoublePrecisionInTiesOnly) {
  DeviceScene scene(device(), soup(), 45, 35, {16, 16});
  const GearsPicture p = render(scene, with());
  expect_only_ties(scene, p);
  expect_consistent(scene, p);
}

TEST_P(GearsAssignment, TakesMasksOfAnySize) {
  const std::pair<int, int> sizes[] = {{1, 1},  {2, 2},  {1, 3},  {5, 7},  {8, 8},
                                       {16, 8}, {33, 2}, {64, 3}, {31, 17}};
  for (const auto& [w, h] : sizes) {
    SCOPED_TRACE(std::to_string(w) + " x " + std::to_string(h));
    DeviceScene scene(device(), soup(), 23, 17, {w, h});
    const GearsPicture p = render(scene, with());
    expect_only_ties(scene, p);
    expect_consistent(scene, p);
  }
}

TEST_P(GearsAssignment, TakesTheLargestMask) {
  DeviceScene scene(device(), soup(60), 9, 7, {64, 64});
  const GearsPicture p = render(scene, with());
  expect_only_ties(scene, p);
  expect_consistent(scene, p);
}

TEST_P(GearsAssignment, TakesAnyCountAndPatternOfLightSamples) {
  for (const int n : {1, 12, 48, 90, 200})
    for (const LightPattern pattern : {LightPattern::regular, LightPattern::jittered, LightPattern::halton}) {
      SCOPED_TRACE(std::to_string(n) + " samples, pattern " + std::to_string(static_cast<int>(pattern)));
      DeviceScene scene(device(), soup(), 19, 15, {0, 0, n, pattern, 5});
      const GearsPicture p = render(scene, with());
      expect_only_ties(scene, p);
      expect_consistent(scene, p);
    }
  DeviceScene jittered(device(), soup(), 19, 15, {8, 8, 0, LightPattern::jittered, 2});
  expect_only_ties(jittered, render(jittered, with()));
}

TEST_P(GearsAssignment, TakesEveryKindOfLight) {
  Light point;
  point.kind = LightKind::point;
  point.center = {1.5f, 3, -1};
  Light inside = point;
  inside.center = {0.1f, 0.5f, 0.1f};  // in the middle of the soup: view samples all around
  Light spot = point;
  spot.kind = LightKind::spot;
  spot.direction = normalize(Vec3f{-1.5f, -3, 1});
  spot.cone_degrees = 14;
  Light sun;
  sun.kind = LightKind::directional;
  sun.direction = normalize(Vec3f{-0.4f, -1, 0.3f});
  Light ball = point;
  ball.kind = LightKind::sphere;
  ball.radius = 0.4f;
  Light window = testing::rectangle_light({1.5f, 3, -1}, {0, 0, 0}, 0.8f, 0.5f);
  window.kind = LightKind::textured_rectangle;
  window.texture_width = 3, window.texture_height = 2;
  window.weights = {0, 1, 2, 4, 0.5f, 3};
  Light cloud = point;
  cloud.kind = LightKind::volume;
  for (int i = 0; i < 50; ++i) {
    const float t = static_cast<float>(i);
    cloud.points.push_back({1.5f + 0.3f * std::cos(t), 3 + 0.01f * t, -1 + 0.3f * std::sin(t)});
    cloud.weights.push_back(1 + 0.1f * t);
  }
  for (const Light& light : {point, inside, spot, sun, ball, window, cloud}) {
    SCOPED_TRACE(to_string(light.kind));
    Frame f = soup();
    f.light = light;
    DeviceScene scene(device(), std::move(f), 41, 33, {6, 6});
    const GearsPicture p = render(scene, with());
    expect_only_ties(scene, p);
    expect_consistent(scene, p);
  }
}

// Triangles on both sides of the light's plane and through it; view samples close before and behind it.
TEST_P(GearsAssignment, IsExactWhereTrianglesCrossTheLightsPlane) {
  for (const uint32_t seed : {1U, 2U, 3U}) {
    Frame f;
    testing::add_ground(f.geometry, 3);
    testing::add_soup(f.geometry, {-1.5f, 0.2f, -1.5f}, {1.5f, 1.6f, 1.5f}, 200, 0.5f, seed);
    f.light = testing::rectangle_light({0, 0.9f, 0}, {0.8f, 0.3f, 0.2f}, 0.7f, 0.4f);
    f.camera = camera_at({0, 2.5f, 4}, {0, 0.5f, 0});
    DeviceScene scene(device(), std::move(f), 37, 53, {16, 16});
    expect_only_ties(scene, render(scene, with()));
  }
}

TEST_P(GearsAssignment, IsExactWithSliversAndFlatTriangles) {
  Frame f = soup(40);
  for (int i = 0; i < 40; ++i) {
    const float x = -0.8f + 0.04f * static_cast<float>(i);
    testing::add_triangle(f.geometry, {x, 0.5f, -0.8f}, {x + 1e-5f, 0.5f, -0.8f}, {x, 0.6f, 0.8f});
    testing::add_triangle(f.geometry, {x, 0.3f, 0}, {x + 0.02f, 0.3f, 0}, {x + 0.04f, 0.3f, 0});  // no area
  }
  DeviceScene scene(device(), std::move(f), 45, 35, {16, 16});
  expect_only_ties(scene, render(scene, with()));
}

TEST_P(GearsAssignment, IsExactWhereGeometryTouchesTheLight) {
  Frame f = soup(60);
  const Light& l = f.light;
  testing::add_triangle(f.geometry, l.at(0, 0), l.at(0.5f, 0), l.at(0, 0.5f) + l.direction * 0.2f);
  testing::add_triangle(f.geometry, l.at(1, 1), l.at(0.6f, 1) + l.direction * 0.01f,
                        l.at(1, 0.6f) - l.direction * 0.3f);
  DeviceScene scene(device(), std::move(f), 45, 35, {16, 16});
  expect_only_ties(scene, render(scene, with()));
}

TEST_P(GearsAssignment, TakesPicturesOfAnySize) {
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{37, 53}, std::pair{3, 129}}) {
    SCOPED_TRACE(std::to_string(w) + " x " + std::to_string(h));
    DeviceScene scene(device(), soup(), w, h, {8, 8});
    const GearsPicture p = render(scene, with());
    expect_consistent(scene, p);
    const BruteForce oracle(scene.frame.geometry);
    const auto truth =
        testing::brute_force_mask(oracle, scene.frame.light, scene.samples, scene.view->host());
    EXPECT_EQ(testing::explain_differences(oracle, scene.frame.light, scene.samples, scene.view->host(),
                                           p.mask, truth, with_view_sample(scene))
                  .unexplained,
              0U);
  }
}

// The turns of a dispatch are few, so that every group goes on many times, with wide subgroups too (32 lanes take
// a quarter of the turns of 8); for the list as well.
TEST_P(GearsOnDevice, GoesOnWhereADispatchEnded) {
  DeviceScene scene(device(), soup(4000), 45, 35, {16, 16});
  const GearsPicture whole = render(scene, with());
  GearsRun run(scene, with({{"dispatch_turns", int64_t{64}}, {"leaf_batch", int64_t{1}}}));
  run.render();
  EXPECT_EQ(run.picture().mask, whole.mask);
  EXPECT_GT(std::get<double>(run.technique().counters().at("walk_dispatches")), 3);
}

// More triangles before each view sample than the 65,535 loop turns after which lavapipe ends loops without a
// word.
TEST_P(GearsOnDevice, SurvivesMoreWorkThanADriverAllowsInOneDispatch) {
  Frame f;
  testing::add_ground(f.geometry, 2);
  testing::add_soup(f.geometry, {0.55f, 1.3f, -0.6f}, {0.95f, 1.7f, -0.4f}, 60000, 0.002f, 7);
  f.light = testing::rectangle_light({1.5f, 3, -1}, {0, 0, 0}, 0.8f, 0.5f);
  f.camera = camera_at({0, 1.5f, 3.5f}, {0, 0, 0});
  DeviceScene scene(device(), std::move(f), 6, 5, {16, 16});
  GearsRun run(scene, with({{"grid_size", int64_t{1}}}));
  run.render();
  EXPECT_GT(std::get<double>(run.technique().counters().at("walk_dispatches")), 2);
  expect_only_ties(scene, run.picture());
}

TEST_P(GearsAssignment, FollowsGeometryAndLightThatMove) {
  DeviceScene scene(device(), soup(), 45, 35, {16, 16});
  GearsRun run(scene, with());
  run.render();
  for (Vec3f& v : scene.frame.geometry.positions)
    if (v.y > 0.05f) v = {v.z * 1.2f, v.y * 1.5f, -v.x};
  scene.frame.geometry.bounds = {};
  for (const Vec3f& v : scene.frame.geometry.positions) scene.frame.geometry.bounds.extend(v);
  scene.frame.light = testing::rectangle_light({-1.5f, 2.5f, 0.3f}, {0, 0, 0}, 0.5f, 0.9f);
  scene.frame.changes = {false, true, true, false};
  scene.samples = make_light_samples(scene.frame.light, {16, 16});
  scene.update();
  run.build();
  run.render();
  expect_only_ties(scene, run.picture());
}

TEST_P(GearsOnDevice, AllocatesNothingAfterTheFirstFrame) {
  DeviceScene scene(device(), soup(), 64, 48, {12, 10});
  GearsRun run(scene, with());
  run.render();
  const uint64_t before = device().allocated_bytes();
  device().reset_peak();
  for (int i = 0; i < 3; ++i) run.render();
  EXPECT_EQ(device().allocated_bytes(), before);
  EXPECT_EQ(device().peak_bytes(), before);
  EXPECT_GT(run.technique().structure_bytes(), 0U);
}

TEST(Gears, BothAssignmentsGiveOneMask) {
  DeviceScene scene(device(), soup(800, 0.08f), 64, 64, {16, 16});
  EXPECT_EQ(render(scene, {{"assignment", std::string("clusters")}}).mask,
            render(scene, {{"assignment", std::string("triangles")}}).mask);
}

TEST(Gears, GivesOneMaskForAllGridSizes) {
  DeviceScene scene(device(), soup(400), 64, 64, {16, 16});
  const auto at = [&](int64_t size) {
    return render(scene, {{"assignment", std::string("triangles")}, {"grid_size", size}}).mask;
  };
  const auto reference = at(128);
  for (const int64_t size : {1, 2, 7, 32, 300, 1024}) EXPECT_EQ(at(size), reference) << size;
}

TEST(Gears, GivesOneMaskWhenTheListsAreMadeInTurns) {
  DeviceScene scene(device(), soup(300, 0.3f), 40, 40, {8, 8});
  const ParamValues few = {
      {"assignment", std::string("triangles")}, {"grid_size", int64_t{256}}, {"list_budget_mib", int64_t{1}}};
  GearsRun run(scene, few);
  run.render();
  const auto mask = run.picture().mask;
  EXPECT_GT(std::get<double>(run.technique().counters().at("chunks")), 2);
  EXPECT_EQ(mask,
            render(scene, {{"assignment", std::string("triangles")}, {"grid_size", int64_t{256}}}).mask);
}

TEST(Gears, MissesOnlyShadowWithThePapersExtrusion) {
  DeviceScene scene(device(), soup(), 45, 35, {16, 16});
  const auto whole = render(scene, {{"assignment", std::string("triangles")}}).mask;
  const auto paper =
      render(scene, {{"assignment", std::string("triangles")}, {"extrusion_length", std::string("paper")}})
          .mask;
  for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_EQ(paper[i] & ~whole[i], 0U);
}

TEST(Gears, CountsWhatItAssigned) {
  DeviceScene scene(device(), soup(), 64, 48, {16, 16});
  for (const std::string& assignment : assignments) {
    GearsRun run(scene, {{"assignment", assignment}, {"grid_size", int64_t{16}}});
    run.render();
    const auto before = run.picture();
    const Counters c = run.technique().counters();
    const auto value = [&](const char* name) { return std::get<double>(c.at(name)); };
    EXPECT_GT(value("necessary_assignments"), 0) << assignment;
    EXPECT_LE(value("necessary_assignments"), value("total_assignments")) << assignment;
    EXPECT_EQ(run.picture().mask, before.mask) << "counting must leave the picture alone";
  }
}

// Assignments by hand: every view sample needs exactly the triangles that hide a light sample from it.
TEST(Gears, CountsNecessaryAssignmentsAsTheOracleDoes) {
  DeviceScene scene(device(), soup(30, 0.4f), 24, 18, {8, 8});
  const auto view = scene.view->host();
  uint64_t necessary = 0;
  for (std::size_t t = 0; t < scene.frame.geometry.triangle_count(); ++t) {
    Geometry one;
    testing::add_triangle(one, scene.frame.geometry.corner(t, 0), scene.frame.geometry.corner(t, 1),
                          scene.frame.geometry.corner(t, 2));
    const BruteForce oracle(one);
    for (std::size_t p = 0; p < view.pixel_count(); ++p) {
      if (view.triangle[p] == no_triangle) continue;
      bool reachable = false, hides = false;
      for (int i = 0; i < scene.samples.count(); ++i) {
        const Vec4f& l = scene.samples.points[static_cast<std::size_t>(i)];
        const Vec4d to{l.x, l.y, l.z, l.w};
        reachable = reachable || !testing::judge_horizon(scene.frame.light, Vec3d(view.position[p].xyz()),
                                                         Vec3d(view.geometric_normal[p].xyz()), to)
                                      .blocked;
        hides = hides || oracle.blocked(Vec3d(view.origin[p].xyz()), to);
      }
      necessary += reachable && hides ? 1 : 0;
    }
  }
  for (const std::string& assignment : assignments) {
    GearsRun run(scene, {{"assignment", assignment}});
    run.render();
    const double counted = std::get<double>(run.technique().counters().at("necessary_assignments"));
    EXPECT_NEAR(counted, static_cast<double>(necessary), 0.01 * static_cast<double>(necessary)) << assignment;
  }
}

TEST(Gears, SaysWhyItCannot) {
  DeviceScene scene(device(), soup(), 16, 16, {8, 8});
  const TechniqueInfo info = gears_technique();
  const auto cpu = info.make(resolve(info.params, {{"backend", std::string("cpu")}}, "gears"));
  EXPECT_FALSE(cpu->supports(scene.scene_case).has_value());
  const auto vulkan = info.make(resolve(info.params, {}, "gears"));
  EXPECT_FALSE(vulkan->supports(scene.scene_case).has_value());
  DeviceScene many(device(), soup(), 16, 16, {0, 0, 5000, LightPattern::halton, 1});
  EXPECT_TRUE(vulkan->supports(many.scene_case).has_value());
  EXPECT_TRUE(cpu->supports(many.scene_case).has_value());
  EXPECT_THROW(resolve(info.params, {{"grid_size", int64_t{0}}}, "gears"), InputError);
  EXPECT_THROW(resolve(info.params, {{"grid_size", int64_t{1025}}}, "gears"), InputError);
}

}  // namespace
}  // namespace penumbra
