// What each technique's picture looks like, as `penumbra render` makes it: nothing that only a look would
// find - a flipped light, a lost instance, another shading - may change unnoticed. How right a picture is,
// other tests say.
#include <fmt/format.h>

#include <cstdlib>

#include "tests/support/golden.h"
#include "tests/support/temporary_folder.h"

namespace penumbra::test {
namespace {

struct Exhibit {
  std::string name, scene, technique, values;
};
void PrintTo(const Exhibit& e, std::ostream* out) { *out << e.name; }

class TechniqueGolden : public testing::TestWithParam<Exhibit> {};

TEST_P(TechniqueGolden, LooksAsItDid) {
  const Exhibit& e = GetParam();
  const char* program = std::getenv("PENUMBRA_PROGRAM");
  ASSERT_NE(program, nullptr);
  TemporaryFolder folder;
  const std::filesystem::path file = folder / (e.name + ".png");
  const std::string command = fmt::format("'{}' render {} {} resolution=160x120 {} -o '{}'", program, e.scene,
                                          e.technique, e.values, file.string());
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  // Another driver's rasteriser, or another version of Embree, may decide single pixels on edges otherwise.
  EXPECT_TRUE(
      matches_golden(read_png(file), fmt::format("tests/golden/techniques/{}.png", e.name), {2, 0.005}));
}

INSTANTIATE_TEST_SUITE_P(
    Each, TechniqueGolden,
    testing::Values(
        Exhibit{"ray_tracing", "torus_knot", "ray_tracing", "mask_size=4"},
        Exhibit{"shadow_map", "artefacts", "shadow_map", "light=lamp map_size=512"},
        Exhibit{"shadow_map_cascades", "avenue", "shadow_map",
                "light=sun map_size=256 cascades=4 constant_bias=0.000002"},
        Exhibit{"shadow_map_variance", "artefacts", "shadow_map",
                "light=key map_size=256 filter=vsm filter_size=9"},
        Exhibit{"shadow_map_per_sample", "torus_knot", "shadow_map_per_sample", "mask_size=4 map_size=256"},
        Exhibit{"planar_shadow", "torus_knot", "planar_shadow", "mask_size=4"},
        Exhibit{"stencil_shadow_volume", "torus_knot", "stencil_shadow_volume", ""},
        Exhibit{"stencil_shadow_volume_per_sample", "torus_knot", "stencil_shadow_volume_per_sample",
                "mask_size=2"},
        Exhibit{"alias_free_shadow_map", "torus_knot", "alias_free_shadow_map", ""},
        Exhibit{"sample_based_soft", "torus_knot", "sample_based_soft", "mask_size=4"},
        Exhibit{"soft_shadow_volume", "torus_knot", "soft_shadow_volume", ""},
        Exhibit{"gears", "torus_knot", "gears", "mask_size=4"},
        Exhibit{"gears_triangles", "columns", "gears", "mask_size=4 assignment=triangles"},
        Exhibit{"gears_cpu", "columns", "gears", "mask_size=4 backend=cpu"},
        Exhibit{"depth_complexity_sampling", "torus_knot", "depth_complexity_sampling", "mask_size=4"},
        Exhibit{"line_space", "torus_knot", "line_space", "mask_size=4"}),
    [](const testing::TestParamInfo<Exhibit>& exhibit) { return exhibit.param.name; });

}  // namespace
}  // namespace penumbra::test
