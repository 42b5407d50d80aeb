// gears on whole scenes, 512 x 512 with 16 x 16 light samples: at most one bit in 100,000 differs from
// Embree, and each that does is a tie in double precision.
#include <gtest/gtest.h>

#include "reference/reference.h"
#include "tests/support/brute_force.h"
#include "tests/techniques/gears_render.h"

namespace penumbra {
namespace {

class GearsScene : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Each, GearsScene, ::testing::Values("bunny", "torus_knot", "bird_nest"));

TEST_P(GearsScene, DiffersFromEmbreeInTiesOnly) {
  static gpu::Device device{gpu::DeviceOptions{}};
  testing::DeviceScene scene(device, Scene::load(GetParam(), {"configs/scenes"}).frame(0, "", "", -1), 512,
                             512, {16, 16});
  const ReferenceScene embree(scene.frame.geometry);
  const MatchedReference truth =
      embree.matched(scene.view->host(), scene.frame.light, scene.samples, ReferenceOrigin::offset);
  const testing::BruteForce oracle(scene.frame.geometry);
  for (const std::string assignment : {"clusters", "triangles"}) {
    SCOPED_TRACE(assignment);
    testing::GearsRun run(scene, {{"assignment", assignment}});
    run.render();
    const auto d = testing::explain_differences(oracle, scene.frame.light, scene.samples, scene.view->host(),
                                                run.picture().mask, truth.mask, truth.evaluated);
    EXPECT_GT(d.bits, 10'000'000U);
    EXPECT_LE(static_cast<double>(d.differing), 1e-5 * static_cast<double>(d.bits));
    EXPECT_EQ(d.unexplained, 0U) << "the worst is " << d.worst << " tolerances from a tie";
    RecordProperty(assignment + "_differing", static_cast<int>(d.differing));
    std::printf("%s, %s: %llu of %llu bits differ; the worst is %.3g tolerances from a tie\n",
                GetParam().c_str(), assignment.c_str(), static_cast<unsigned long long>(d.differing),
                static_cast<unsigned long long>(d.bits), d.worst);
  }
  EXPECT_EQ(device.validation_messages(), std::vector<std::string>{});
}

}  // namespace
}  // namespace penumbra
