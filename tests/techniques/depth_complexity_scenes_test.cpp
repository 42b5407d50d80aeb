// depth_complexity_sampling on whole scenes, 512 x 512 with 16 x 16 light samples: at most one bit in 100,000
// differs from Embree, and each that does is a tie in double precision.
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

class DepthComplexityScene : public ::testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(
    Each, DepthComplexityScene,
    ::testing::Values(
        Variant{"bunny", "bunny", as_it_is}, Variant{"torus_knot", "torus_knot", as_it_is},
        Variant{"bird_nest", "bird_nest", as_it_is},
        Variant{"bunny_with_holes", "study_bunny", [](Geometry& g) { testing::remove_triangles(g, 0.1, 2); }},
        Variant{"bunny_flipped", "study_bunny", [](Geometry& g) { testing::flip_triangles(g, 0.3); }},
        Variant{"bunny_unindexed", "study_bunny", [](Geometry& g) { testing::make_soup(g, 0); }},
        Variant{"bunny_soup", "study_bunny", [](Geometry& g) { testing::make_soup(g, 1e-3F); }}),
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
