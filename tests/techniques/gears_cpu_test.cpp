// gears on the host against the device and against itself: the same masks whatever the backend, the grid, the
// room for lists and the instruction set. Its proof against double precision stands in gears_test.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <bit>

#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"
#include "tests/techniques/frame_allocations.h"
#include "tests/techniques/gears_render.h"

namespace penumbra {
namespace {

using testing::DeviceScene;
using testing::GearsPicture;
using testing::GearsRun;

gpu::Device& device() {
  static gpu::Device d{gpu::DeviceOptions{}};
  return d;
}

// Ground, a soup of triangles over it, and a few through the light's plane.
Frame soup(int count) {
  Frame f;
  testing::add_ground(f.geometry, 2);
  testing::add_soup(f.geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, count, 0.1F, 3);
  testing::add_soup(f.geometry, {0.5F, 2, -1.5F}, {2.5F, 3.5F, -0.5F}, 20, 0.5F, 4);
  f.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F);
  f.camera.eye = {0, 1.5F, 3.5F}, f.camera.target = {0, 0.6F, 0};
  return f;
}

GearsPicture render(DeviceScene& scene, ParamValues params, const std::string& backend = "cpu") {
  params["backend"] = backend;
  GearsRun run(scene, params);
  run.render();
  return run.picture();
}

std::size_t differing_bits(const DeviceScene& scene, const std::vector<uint32_t>& a,
                           const std::vector<uint32_t>& b) {
  const auto words = static_cast<std::size_t>(scene.samples.mask_words());
  std::size_t bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (scene.view->host().triangle[i / words] != no_triangle)
      bits += static_cast<std::size_t>(std::popcount(a[i] ^ b[i]));
  return bits;
}

class GearsCpu : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Each, GearsCpu, ::testing::Values("clusters", "triangles"));

// Both differ from double precision in ties only (gears_test); they round alike but for what a device fuses.
TEST_P(GearsCpu, GivesTheMasksOfTheDevice) {
  const std::pair<int, int> sizes[] = {{16, 16}, {32, 32}, {5, 7}, {64, 8}};
  for (const auto& [w, h] : sizes) {
    DeviceScene scene(device(), soup(600), 64, 48, {w, h});
    const auto host = render(scene, {{"assignment", GetParam()}}).mask,
               there = render(scene, {{"assignment", GetParam()}}, "vulkan").mask;
    EXPECT_LE(differing_bits(scene, host, there), host.size() * 32 / 100'000) << w << " x " << h;
  }
}

TEST_P(GearsCpu, GivesOneMaskOnEveryInstructionSet) {
  for (const LightSampleRequest& request : {LightSampleRequest{16, 16}, LightSampleRequest{33, 20},
                                            LightSampleRequest{0, 0, 90, LightPattern::halton, 1}}) {
    DeviceScene scene(device(), soup(400), 48, 40, request);
    const std::vector<uint32_t> best = render(scene, {{"assignment", GetParam()}}).mask;
    const int64_t all = hwy::SupportedTargets();
    for (int64_t left = all; left != 0; left &= left - 1) {
      hwy::SetSupportedTargetsForTest(left & -left);
      EXPECT_EQ(render(scene, {{"assignment", GetParam()}}).mask, best) << hwy::TargetName(left & -left);
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

TEST_P(GearsCpu, GivesOneMaskForAllGridSizes) {
  DeviceScene scene(device(), soup(400), 64, 64, {16, 16});
  const auto at = [&](int64_t size) {
    return render(scene, {{"assignment", GetParam()}, {"grid_size", size}}).mask;
  };
  const auto reference = at(128);
  for (const int64_t size : {1, 2, 7, 300, 1024}) EXPECT_EQ(at(size), reference) << size;
}

TEST_P(GearsCpu, AllocatesNothingAfterTheFirstFrames) {
  for (const LightSampleRequest& request : {LightSampleRequest{12, 10}, LightSampleRequest{40, 40},
                                            LightSampleRequest{0, 0, 90, LightPattern::halton, 1}}) {
    DeviceScene scene(device(), soup(400), 64, 48, request);
    GearsRun run(scene, {{"assignment", GetParam()}, {"backend", std::string("cpu")}});
    for (int i = 0; i < 3; ++i) run.render();
    const uint64_t bytes = run.technique().structure_bytes();
    EXPECT_EQ(testing::fewest_frame_allocations(scene.passes, [&] { run.render(); }), 0)
        << scene.samples.count();
    EXPECT_EQ(run.technique().structure_bytes(), bytes);
    EXPECT_GT(bytes, 0U);
  }
}

TEST(GearsCpu, BothAssignmentsGiveOneMask) {
  DeviceScene scene(device(), soup(800), 64, 64, {16, 16});
  EXPECT_EQ(render(scene, {{"assignment", std::string("clusters")}}).mask,
            render(scene, {{"assignment", std::string("triangles")}}).mask);
}

TEST(GearsCpu, GivesOneMaskWhenTheListsAreMadeInTurns) {
  // More than a worker's share of a mebibyte in a row of cells.
  DeviceScene scene(device(), soup(8000), 40, 40, {8, 8});
  const ParamValues params = {{"assignment", std::string("triangles")}, {"grid_size", int64_t{64}}};
  ParamValues few = params;
  few["list_budget_mib"] = int64_t{1};
  EXPECT_EQ(render(scene, few).mask, render(scene, params).mask);
}

TEST(GearsCpu, MissesOnlyShadowWithThePapersExtrusion) {
  DeviceScene scene(device(), soup(200), 45, 35, {16, 16});
  const ParamValues triangles = {{"assignment", std::string("triangles")}};
  ParamValues paper = triangles;
  paper["extrusion_length"] = std::string("paper");
  const auto whole = render(scene, triangles).mask, less = render(scene, paper).mask;
  for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_EQ(less[i] & ~whole[i], 0U);
}

TEST(GearsCpu, CountsWhatItDid) {
  DeviceScene scene(device(), soup(300), 64, 48, {16, 16});
  for (const std::string assignment : {"clusters", "triangles"}) {
    GearsRun run(scene, {{"assignment", assignment}, {"backend", std::string("cpu")}});
    run.render();
    const Counters c = run.technique().counters();
    const auto value = [&](const char* name) { return std::get<double>(c.at(name)); };
    EXPECT_GT(value("pairs_rasterised"), 0) << assignment;
    EXPECT_GT(value("view_samples_per_cell_average"), 0) << assignment;
    EXPECT_GE(value("vector_lanes"), 1) << assignment;
  }
}

}  // namespace
}  // namespace penumbra
