// gears on whole scenes, 512 x 512 with 16 x 16 light samples: at most one bit in 100,000 differs from
// Embree, and each that does is a tie in double precision; by both assignments and backends.
// PENUMBRA_FULL_PROOF=1: the backend of the host on all scenes of the study too, up to the dragon of 871,000
// triangles (some minutes). The church is built of pieces that touch in common planes and edges: more of its
// bits are ties, each of them shown to be one.
#include <gtest/gtest.h>

#include <cstdlib>

#include "reference/reference.h"
#include "tests/support/brute_force.h"
#include "tests/techniques/gears_render.h"

namespace penumbra {
namespace {

class GearsScene : public ::testing::TestWithParam<std::string> {};
std::vector<std::string> scenes() {
  std::vector<std::string> names = {"bunny", "torus_knot", "bird_nest", "church"};
  if (std::getenv("PENUMBRA_FULL_PROOF"))
    for (const char* scene : {"study_city", "study_dragon4", "study_dragon3", "study_knots", "study_bunny",
                              "study_nest", "study_dragon2", "study_hair", "study_dragon1"})
      names.emplace_back(scene);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Each, GearsScene, ::testing::ValuesIn(scenes()));

// Assignment and backend.
std::vector<std::pair<std::string, std::string>> runs_of(const std::string& scene) {
  if (scene.starts_with("study_")) return {{"clusters", "cpu"}, {"triangles", "cpu"}};
  return {{"clusters", "vulkan"}, {"triangles", "vulkan"}, {"clusters", "cpu"}};
}

TEST_P(GearsScene, DiffersFromEmbreeInTiesOnly) {
  static gpu::Device device{gpu::DeviceOptions{}};
  const bool church = GetParam() == "church";
  const int side = church ? 256 : 512;
  testing::DeviceScene scene(device, Scene::load(GetParam(), {"configs/scenes"}).frame(0, "", "", -1), side,
                             side, {16, 16});
  const ReferenceScene embree(scene.frame.geometry);
  const MatchedReference truth =
      embree.matched(scene.view->host(), scene.frame.light, scene.samples, ReferenceOrigin::offset);
  const testing::BruteForce oracle(scene.frame.geometry);
  for (const auto& [assignment, backend] : runs_of(GetParam())) {
    SCOPED_TRACE(assignment + ", " + backend);
    testing::GearsRun run(scene, {{"assignment", assignment}, {"backend", backend}});
    run.render();
    const auto d = testing::explain_differences(oracle, scene.frame.light, scene.samples, scene.view->host(),
                                                run.picture().mask, truth.mask, truth.evaluated);
    EXPECT_GT(d.bits, church ? 5'000'000U : 10'000'000U);
    EXPECT_LE(static_cast<double>(d.differing), (church ? 1e-4 : 1e-5) * static_cast<double>(d.bits));
    EXPECT_EQ(d.unexplained, 0U) << "the worst is " << d.worst << " tolerances from a tie";
    RecordProperty(assignment + "_" + backend + "_differing", static_cast<int>(d.differing));
    std::printf("%s, %s, %s: %llu of %llu bits differ; the worst is %.3g tolerances from a tie\n",
                GetParam().c_str(), assignment.c_str(), backend.c_str(),
                static_cast<unsigned long long>(d.differing), static_cast<unsigned long long>(d.bits),
                d.worst);
  }
  EXPECT_EQ(device.validation_messages(), std::vector<std::string>{});
}

}  // namespace
}  // namespace penumbra
