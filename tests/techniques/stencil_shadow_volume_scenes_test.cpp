// Shadow volumes on the scenes of configs/scenes against Embree: off in at most one of a hundred pixels on a
// shadow boundary, nowhere else, and only where the answer flips when P moves by 1/64 of a pixel.
// PENUMBRA_FULL_PROOF=1: at 1024 x 1024, with the full dragon too (some minutes); else small pictures.
#include <cstdlib>

#include "near_plane_clear.h"
#include "stencil_planar_stage.h"
#include "techniques/stencil_shadow_volume/stencil_shadow_volume.h"

namespace penumbra::test {
namespace {

const TechniqueInfo info = stencil_shadow_volume_technique();
const bool full = std::getenv("PENUMBRA_FULL_PROOF") != nullptr;
const int side = full ? 1024 : 200;

ParamValues params(const char* variant, const char* extrusion) {
  return {{"variant", std::string(variant)}, {"extrusion", std::string(extrusion)}};
}

Frame frame(const char* scene, const char* light) {
  return Scene::load(scene, {"configs/scenes"}).frame(0, light, "", -1);
}

std::vector<std::pair<const char*, const char*>> views() {
  std::vector<std::pair<const char*, const char*>> v{
      {"bunny", "lamp"},   {"bunny", "sun"},      {"torus_knot", "lamp"}, {"torus_knot", "sun"},
      {"columns", "lamp"}, {"bird_nest", "lamp"}, {"bird_nest", "sun"}};
  if (full) v.insert(v.end(), {{"dragon", "lamp"}, {"dragon", "sun"}});
  return v;
}

class OnScenes : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(StencilShadowVolume, OnScenes, ::testing::ValuesIn(views()),
                         [](const auto& i) { return std::string(i.param.first) + "_" + i.param.second; });

// z-pass has to equal z-fail there, since the near plane lies outside all volumes.
TEST_P(OnScenes, DifferFromTheReferenceOnlyInTiesOnShadowBoundaries) {
  const auto [scene, light] = GetParam();
  Stage stage(frame(scene, light), side, side);
  ASSERT_TRUE(near_plane_is_clear(stage));
  const std::vector<uint8_t> boundary = stage.shadow_boundary();
  double boundary_pixels = 0;
  for (uint8_t b : boundary) boundary_pixels += b;
  ASSERT_GT(boundary_pixels, 500);
  for (const char* extrusion : {"silhouette", "per_triangle"}) {
    std::vector<float> z_fail;
    for (const char* variant : {"z_fail", "z_pass", "zp_plus"}) {
      SCOPED_TRACE(std::string(variant) + " " + extrusion);
      const Rendered r = stage.render(*stage.built(info, params(variant, extrusion)), false, false);
      if (z_fail.empty()) z_fail = r.visibility;
      EXPECT_TRUE(variant == std::string("zp_plus") || stage.differing(r.visibility, z_fail).empty());
      const std::vector<std::size_t> off = stage.differing(r);
      std::size_t away = 0;  // thin shadows have boundaries within a pixel that no neighbour shows
      for (std::size_t i : off) away += !boundary[i] && !stage.moved_is(i, 1.0 / 64, r.visibility[i] != 0);
      EXPECT_EQ(away, 0U) << "pixels away from shadow boundaries";
      EXPECT_LE(double(off.size()), 0.01 * boundary_pixels);
      stage.expect_only_ties(r);
      std::printf("[measured] %s %s %s %s: %zu of %.0f boundary pixels off, %zu of them no ties\n", scene,
                  light, variant, extrusion, off.size(), boundary_pixels, stage.no_ties(r).size());
      std::fflush(stdout);
    }
  }
}

// The sun of `columns` shines along facets of the columns: whether a point of these is lit is rounding.
TEST(StencilShadowVolume, FacetsAlongTheLightAreTies) {
  Stage stage(frame("columns", "sun"), side, side);
  for (const char* extrusion : {"silhouette", "per_triangle"})
    stage.expect_only_ties(stage.render(info, params("z_fail", extrusion)));
}

}  // namespace
}  // namespace penumbra::test
