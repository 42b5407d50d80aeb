// What a person sees of a scene: camera, light, shading and shadow in one picture, which no error metric
// looks at (they compare pictures that were made alike).
#include <nlohmann/json.hpp>

#include "config/expand.h"
#include "run/still.h"
#include "techniques/registry.h"
#include "tests/support/golden.h"

namespace penumbra {
namespace {

const std::vector<std::filesystem::path> scenes = {"configs/scenes"};

Rgb8Image picture(const std::string& technique) {
  const Registry registry = all_techniques();
  const nlohmann::json config = {
      {"scene", "torus_knot"}, {"resolution", {{96, 64}}}, {"mask_size", 4}, {"techniques", {technique}}};
  const Sweep sweep = parse_sweep(JsonDocument::parse(config.dump(), "golden"), registry, "golden");
  const std::vector<Point> points =
      expand(sweep, [](const std::string& name) { return declare_scene(name, scenes); });
  const run::Still still = run::render_still(points.at(0), registry, scenes, "");
  return tonemap(still.shaded, still.width, still.height);
}

// Drivers may put a pixel of an outline on either side of it, and a light sample that grazes an edge as well:
// at most one pixel in 50, and elsewhere the last two codes of a channel.
constexpr test::GoldenBound outlines{2, 0.02};

TEST(TechniqueGolden, ARayTracedSoftShadowLooksAsBefore) {
  EXPECT_TRUE(test::matches_golden(picture("ray_tracing"), "tests/golden/ray_tracing.png", outlines));
}

TEST(TechniqueGolden, AShadowMapLooksAsBefore) {
  EXPECT_TRUE(test::matches_golden(picture("shadow_map"), "tests/golden/shadow_map.png", outlines));
}

// The same light samples, the same picture.
TEST(TechniqueGolden, GearsLooksAsRayTracing) {
  EXPECT_TRUE(test::matches_golden(picture("gears"), "tests/golden/ray_tracing.png", outlines));
}

}  // namespace
}  // namespace penumbra
