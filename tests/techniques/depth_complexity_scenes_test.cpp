// depth_complexity_sampling on whole scenes, 512 x 512 with 16 x 16 light samples: at most one bit in 100,000
// differs from Embree, and each that does is a tie in double precision.
// PENUMBRA_FULL_PROOF=1: on all scenes of the study too, up to the dragon of 871,000 triangles (some
// minutes).
#include <cstdlib>

#include "tests/techniques/depth_complexity_render.h"

namespace penumbra {
namespace {

gpu::Device& device() {
  static gpu::Device d{gpu::DeviceOptions{}};
  return d;
}

struct Variant {
  const char* name;
  const char* scene;
  void (*change)(Geometry&);
};
void as_it_is(Geometry&) {}

std::vector<Variant> variants() {
  std::vector<Variant> v = {
      {"bunny", "bunny", as_it_is},
      {"torus_knot", "torus_knot", as_it_is},
      {"bird_nest", "bird_nest", as_it_is},
      {"bunny_with_holes", "study_bunny", [](Geometry& g) { testing::remove_triangles(g, 0.1, 2); }},
      {"bunny_flipped", "study_bunny", [](Geometry& g) { testing::flip_triangles(g, 0.3); }},
      {"bunny_unindexed", "study_bunny", [](Geometry& g) { testing::make_soup(g, 0); }},
      {"bunny_soup", "study_bunny", [](Geometry& g) { testing::make_soup(g, 1e-3F); }}};
  if (std::getenv("PENUMBRA_FULL_PROOF"))
    for (const char* scene : {"study_city", "study_dragon4", "study_dragon3", "study_knots", "study_bunny",
                              "study_nest", "study_dragon2", "study_hair", "study_dragon1"})
      v.push_back({scene, scene, as_it_is});
  return v;
}

class DepthComplexityScene : public ::testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(Each, DepthComplexityScene, ::testing::ValuesIn(variants()),
                         [](const auto& variant) { return std::string(variant.param.name); });

TEST_P(DepthComplexityScene, DiffersFromEmbreeInTiesOnly) {
  Frame frame = Scene::load(GetParam().scene, {"configs/scenes"}).frame(0, "", "", -1);
  GetParam().change(frame.geometry);
  testing::DeviceScene scene(device(), std::move(frame), 512, 512, {16, 16});
  testing::DepthComplexityRun run(scene);
  run.build();
  run.render();
  testing::expect_the_reference(scene, run.mask, GetParam().name);
  EXPECT_EQ(device().validation_messages(), std::vector<std::string>{});
}

}  // namespace
}  // namespace penumbra
