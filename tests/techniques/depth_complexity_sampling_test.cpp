// depth_complexity_sampling on small scenes, each made for one difficulty, against robust Embree with every
// differing bit explained in double precision; its edges; and the same masks from every instruction set.
#include <hwy/targets.h>

#include <set>

#include "techniques/common/exact_choice.h"
#include "techniques/depth_complexity_sampling/kernel.h"
#include "tests/support/host_view.h"
#include "tests/techniques/depth_complexity_render.h"
#include "tests/techniques/frame_allocations.h"

namespace penumbra {
namespace {

using depth_complexity::Edge;
using depth_complexity::EdgeTopology;
using depth_complexity::find_edges;
using testing::DepthComplexityRun;
using testing::DeviceScene;

gpu::Device& device() {
  static gpu::Device d{gpu::DeviceOptions{}};
  return d;
}

// A soup over a ground, under a rectangle.
Frame soup_frame(int triangles = 150) {
  Frame f;
  testing::add_ground(f.geometry, 2);
  testing::add_soup(f.geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, triangles, 0.3F, 11);
  f.camera.eye = {0, 1.5F, 3.5F}, f.camera.target = {0, 0.4F, 0};
  f.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F);
  return f;
}

std::vector<uint32_t> masks(DeviceScene& scene, const ParamValues& given = {}) {
  DepthComplexityRun run(scene, given);
  EXPECT_FALSE(run.technique().supports(scene.scene_case));
  run.build();
  run.render();
  return run.mask;
}

void expect_ties_only(Frame frame, const LightSampleRequest& request, const char* name) {
  DeviceScene scene(device(), std::move(frame), 97, 71, request);
  testing::expect_the_reference(scene, masks(scene), name, 1e-4);
  EXPECT_EQ(device().validation_messages(), std::vector<std::string>{});
}

TEST(DepthComplexityEdges, OfAClosedBoxAreTwelveAndItsDiagonals) {
  Geometry g;
  testing::add_box(g, {0, 0, 0}, {1, 1, 1});
  const EdgeTopology t = find_edges(g);
  EXPECT_EQ(t.mesh_vertex.size(), 8U);
  EXPECT_EQ(t.edges.size(), 18U);
  EXPECT_EQ(t.open + t.inconsistent + t.non_manifold + t.dropped_faces, 0U);
  for (const Edge& e : t.edges) EXPECT_NE(e.face, e.second_face());
}

TEST(DepthComplexityEdges, WeldMinusZeroToZero) {
  Geometry g;
  testing::add_triangle(g, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  testing::add_triangle(g, {1, -0.0F, -0.0F}, {-0.0F, 0, -0.0F}, {0, -1, 0});
  EXPECT_EQ(find_edges(g).open, 4U);
}

TEST(DepthComplexityEdges, OfThreeFacesAreTwoRecords) {
  Geometry g;
  testing::add_triangle(g, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  testing::add_triangle(g, {0, 0, 0}, {0, 0, 1}, {-1, 1, 0});
  testing::add_triangle(g, {0, 0, 1}, {0, 0, 0}, {-1, -1, 0});
  const EdgeTopology t = find_edges(g);
  EXPECT_EQ(t.non_manifold, 1U);
  EXPECT_EQ(t.open, 7U);
  EXPECT_EQ(t.edges.size(), 8U);
}

TEST(DepthComplexityEdges, OfFacesThatRunTheSameWayAreFlipped) {
  Geometry g;
  testing::add_triangle(g, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  testing::add_triangle(g, {0, 0, 0}, {0, 0, 1}, {-1, 1, 0});
  const EdgeTopology t = find_edges(g);
  EXPECT_EQ(t.inconsistent, 1U);
  EXPECT_EQ(t.open, 4U);
}

TEST(DepthComplexityEdges, LeaveOutFacesWithTwoCornersAtOnePlace) {
  Geometry g;
  testing::add_triangle(g, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  g.positions.push_back({0, 0, 1}), g.normals.push_back({0, 1, 0});
  g.indices.insert(g.indices.end(), {0, 1, static_cast<uint32_t>(g.positions.size() - 1)});
  g.triangle_instance.push_back(0);
  const EdgeTopology t = find_edges(g);
  EXPECT_EQ(t.dropped_faces, 1U);
  EXPECT_EQ(t.edges.size(), 3U);
}

TEST(DepthComplexitySampling, TakesGridsOfAnySize) {
  for (const auto& [w, h] : std::vector<std::pair<int, int>>{
           {1, 1}, {4, 4}, {5, 3}, {12, 7}, {16, 8}, {17, 33}, {32, 32}, {40, 24}, {64, 64}})
    expect_ties_only(soup_frame(), {w, h}, "grid");
}

TEST(DepthComplexitySampling, TakesAnyCountAndPattern) {
  for (const LightPattern pattern : {LightPattern::regular, LightPattern::jittered, LightPattern::halton})
    for (const int n : {0, 12, 90, 257}) expect_ties_only(soup_frame(), {16, 16, n, pattern, 3}, "set");
}

TEST(DepthComplexitySampling, TakesEveryLightWithPoints) {
  for (const LightKind kind : {LightKind::sphere, LightKind::point, LightKind::spot,
                               LightKind::textured_rectangle, LightKind::volume}) {
    Frame f = soup_frame();
    f.light.kind = kind;
    f.light.radius = 0.3F, f.light.cone_degrees = 20;
    f.light.texture_width = 2, f.light.texture_height = 1, f.light.weights = {0.2F, 0.8F};
    if (kind == LightKind::volume) {
      f.light.points = {{1, 3, -1}, {1.5F, 3.2F, -1}, {1.2F, 2.8F, -0.7F}};
      f.light.weights = {};
    }
    expect_ties_only(f, {8, 8}, to_string(kind));
  }
}

TEST(DepthComplexitySampling, RefusesWhatItCannotDo) {
  DeviceScene scene(device(), soup_frame(), 8, 8, {4, 4});
  DepthComplexityRun run(scene);
  EXPECT_FALSE(run.technique().supports(scene.scene_case));
  scene.frame.light.kind = LightKind::directional;
  scene.samples = make_light_samples(scene.frame.light, {4, 4});
  EXPECT_TRUE(run.technique().supports(scene.scene_case));
  scene.frame.light.kind = LightKind::sphere;
  scene.frame.light.radius = 0.5F;
  scene.frame.light.center = {0, 0.5F, 0};
  scene.samples = make_light_samples(scene.frame.light, {4, 4});
  EXPECT_TRUE(run.technique().supports(scene.scene_case));
  scene.frame = soup_frame();
  scene.samples = make_light_samples(scene.frame.light, {65, 65});
  EXPECT_TRUE(run.technique().supports(scene.scene_case));
  scene.frame.geometry = {};
  scene.samples = make_light_samples(scene.frame.light, {4, 4});
  EXPECT_TRUE(run.technique().supports(scene.scene_case));
}

// Boxes behind the light, through its plane, and through the light itself.
TEST(DepthComplexitySampling, CutsMeshesAtTheLightsPlane) {
  Frame f = soup_frame(40);
  f.light = testing::rectangle_light({0, 1.2F, 0}, {0, 0, 0}, 1, 0.8F);
  testing::add_box(f.geometry, {-0.3F, 0.9F, -0.2F}, {0.1F, 1.6F, 0.05F});
  testing::add_box(f.geometry, {0.2F, 1.1F, -0.3F}, {0.7F, 1.3F, 0.3F});
  testing::add_box(f.geometry, {-1, 1.4F, -1}, {1, 1.5F, 1});
  testing::add_triangle(f.geometry, {-2, 0.6F, -2}, {2, 2, 0.1F}, {0.3F, 0.7F, 2});
  expect_ties_only(f, {16, 16}, "cut");
  expect_ties_only(f, {16, 16, 100, LightPattern::halton, 1}, "cut, set");
}

// View samples all about, with edges before, behind and across their planes: a low light.
TEST(DepthComplexitySampling, SeesEdgesBehindTheViewSample) {
  Frame f = soup_frame();
  f.light = testing::rectangle_light({1.5F, 0.7F, -1}, {0, 0.5F, 0}, 0.8F, 0.5F);
  expect_ties_only(f, {16, 16}, "low light");
}

TEST(DepthComplexitySampling, TakesDegenerateAndRepeatedFaces) {
  Frame f = soup_frame(60);
  testing::add_box(f.geometry, {-0.2F, 0.2F, -0.2F}, {0.2F, 0.6F, 0.2F});
  testing::add_box(f.geometry, {-0.2F, 0.2F, -0.2F}, {0.2F, 0.6F, 0.2F});
  testing::add_box(f.geometry, {0.2F, 0.2F, -0.2F}, {0.4F, 0.6F, 0.2F});
  testing::add_triangle(f.geometry, {0, 1, 0}, {0.5F, 1, 0}, {1, 1, 0});
  testing::add_triangle(f.geometry, {0, 1, 0}, {0, 1, 0}, {1, 1, 0});
  testing::flip_triangles(f.geometry, 0.3);
  expect_ties_only(f, {16, 16}, "degenerate");
}

// A hundred layers one behind the other: more than 8 bits count.
TEST(DepthComplexitySampling, CountsManyLayers) {
  Frame f = soup_frame(0);
  for (int i = 0; i < 200; ++i) {
    const float y = 0.2F + 0.005F * static_cast<float>(i), x = 0.001F * static_cast<float>(i % 7);
    testing::add_triangle(f.geometry, {-0.7F + x, y, -0.6F}, {0.8F - x, y, -0.5F + x}, {0.1F, y, 0.9F});
  }
  DeviceScene scene(device(), f, 97, 71, {16, 16});
  DepthComplexityRun run(scene);
  run.build();
  run.render();
  EXPECT_GT(run.counter("view_samples_with_wide_counters"), 0);
  testing::expect_the_reference(scene, run.mask, "layers", 1e-4);
}

// A light so near before the ground that P' of every ground sample lies behind its plane, and P before it.
TEST(DepthComplexitySampling, TakesViewSamplesInTheLightsPlane) {
  Frame f = soup_frame(40);
  testing::add_box(f.geometry, {-0.2F, 0, -0.3F}, {0.2F, 0.4F, 0.1F});
  f.light = testing::rectangle_light({1.5F, 1e-6F, 0}, {1.5F, -1, 0}, 0.8F, 0.5F);
  DeviceScene scene(device(), std::move(f), 97, 71, {8, 8});
  DepthComplexityRun run(scene);
  run.build();
  run.render();
  EXPECT_GT(run.counter("view_samples_traced"), 1000);
  testing::expect_the_reference(scene, run.mask, "in_the_plane", 0);
}

TEST(DepthComplexitySampling, GivesTheSameMasksOnEveryInstructionSet) {
  Frame f = soup_frame();
  f.light = testing::rectangle_light({1.5F, 1.2F, -1}, {0, 0.5F, 0}, 0.8F, 0.5F);
  for (const LightSampleRequest& request :
       std::vector<LightSampleRequest>{{16, 16}, {33, 17}, {5, 5, 77, LightPattern::halton, 1}}) {
    DeviceScene scene(device(), f, 97, 71, request);
    hwy::SetSupportedTargetsForTest(0);
    const std::vector<uint32_t> truth = masks(scene);
    std::set<std::string> names;
    for (int64_t rest = hwy::SupportedTargets(); rest; rest &= rest - 1) {
      hwy::SetSupportedTargetsForTest(rest & -rest);
      SCOPED_TRACE(depth_complexity::instruction_set());
      names.insert(depth_complexity::instruction_set());
      EXPECT_EQ(masks(scene), truth);
    }
    hwy::SetSupportedTargetsForTest(0);
    EXPECT_GT(names.size(), 1U);
  }
}

// A closed mesh has few edges that can be silhouettes, a soup has nothing else: the advice follows.
TEST(ExactChoice, FollowsTheShareOfPotentialSilhouettes) {
  const auto share_of = [](Geometry g) {
    Frame f;
    f.geometry = std::move(g);
    testing::add_ground(f.geometry, 2);
    f.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F);
    f.camera.eye = {0, 1.5F, 3.5F}, f.camera.target = {0, 0.4F, 0};
    DeviceScene scene(device(), std::move(f), 32, 32, {4, 4});
    DepthComplexityRun run(scene);
    run.build();
    run.render();
    return run.counter("potential_silhouette_share");
  };
  Geometry closed;
  for (int i = 0; i < 20; ++i) {
    const float x = -0.9F + 0.09F * static_cast<float>(i);
    testing::add_box(closed, {x, 0.2F, -0.1F}, {x + 0.05F, 0.5F, 0.1F});
  }
  Geometry soup;
  testing::add_soup(soup, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, 100, 0.3F, 11);
  EXPECT_EQ(expected_fastest(share_of(closed)), "depth_complexity_sampling");
  EXPECT_EQ(expected_fastest(share_of(soup)), "gears");
}

TEST(DepthComplexitySampling, FollowsMovingGeometry) {
  for (const bool dynamic : {false, true}) {
    DeviceScene scene(device(), soup_frame(), 97, 71, {8, 8});
    DepthComplexityRun run(scene, {{"dynamic", dynamic}});
    run.build();
    for (int i = 0; i < 2; ++i) {
      for (std::size_t v = 6; v < scene.frame.geometry.positions.size(); ++v)
        scene.frame.geometry.positions[v].x += 0.01F * static_cast<float>(v % 5);
      scene.frame.changes = {false, true, false, false};
      scene.update();
      run.build();
      run.render();
      testing::expect_the_reference(scene, run.mask, "moved", 1e-4);
    }
  }
}

// Two boxes share a face's corners at first, and then part.
TEST(DepthComplexitySampling, PartsWhatWasWelded) {
  Frame f = soup_frame(0);
  testing::add_box(f.geometry, {-0.5F, 0.3F, -0.2F}, {0, 0.6F, 0.2F});
  const std::size_t second = f.geometry.positions.size();
  testing::add_box(f.geometry, {0, 0.3F, -0.2F}, {0.5F, 0.6F, 0.2F});
  DeviceScene scene(device(), f, 97, 71, {8, 8});
  DepthComplexityRun run(scene);
  run.build();
  for (std::size_t v = second; v < scene.frame.geometry.positions.size(); ++v)
    scene.frame.geometry.positions[v].x += 0.2F;
  scene.frame.changes = {false, true, false, false};
  scene.update();
  run.build();
  run.render();
  testing::expect_the_reference(scene, run.mask, "parted", 1e-4);
}

TEST(DepthComplexitySampling, AllocatesNothingAfterTheFirstFrames) {
  for (const LightSampleRequest& request : {LightSampleRequest{16, 16}, LightSampleRequest{40, 40},
                                            LightSampleRequest{0, 0, 90, LightPattern::halton, 1}}) {
    DeviceScene scene(device(), soup_frame(), 97, 71, request);
    DepthComplexityRun run(scene);
    run.build();
    for (int i = 0; i < 3; ++i) run.render();
    const uint64_t bytes = run.technique().structure_bytes();
    EXPECT_EQ(testing::fewest_frame_allocations(scene.passes, [&] { run.render(); }), 0)
        << scene.samples.count();
    EXPECT_EQ(run.technique().structure_bytes(), bytes);
  }
}

TEST(DepthComplexitySampling, CountsEdgesAndRays) {
  DeviceScene scene(device(), soup_frame(), 97, 71, {16, 16});
  DepthComplexityRun run(scene);
  run.build();
  run.render();
  EXPECT_GT(run.counter("edges"), run.counter("potential_silhouette_edges") - 1);
  EXPECT_GT(run.counter("potential_silhouette_edges"), 100);
  EXPECT_GT(run.counter("edges_tested_per_view_sample"), run.counter("silhouette_edges_per_view_sample"));
  EXPECT_LE(run.counter("rays"), run.counter("view_samples"));
  EXPECT_GT(run.counter("rays"), 0);
  EXPECT_GE(run.technique().structure_bytes(), static_cast<uint64_t>(run.counter("topology_bytes")));
}

}  // namespace
}  // namespace penumbra
