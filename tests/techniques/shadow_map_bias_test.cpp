// Bias, faces, depth formats and percentage-closer filtering against closed forms.
#include "shadow_map_scenes.h"
#include "techniques/common/shadow_maps/lookup.h"

namespace penumbra::test {
namespace {

constexpr int width = 161, height = 119;  // odd and not square

TEST(ShadowMap, CasterFacesAreThoseTowardsOrAwayFromTheLight) {
  for (const bool towards : {true, false}) {
    Frame f;
    add_ground(f.geometry, 2);
    if (towards)
      add_quad(f.geometry, {-0.5f, 1, 0.5f}, {1, 0, 0}, {0, 0, -1});  // normal up
    else
      add_quad(f.geometry, {-0.5f, 1, 0.5f}, {0, 0, -1}, {1, 0, 0});
    f.light = point_light({0, 3, 0});
    f.camera.eye = {0, 0.7f, 3}, f.camera.target = {0, 0, 0};
    Stage stage(std::move(f), width, height);
    const double right = towards ? stage.error(stage.render(unfiltered({{"caster_faces", "front"}})))
                                 : stage.error(stage.render(unfiltered({{"caster_faces", "back"}})));
    const double wrong = towards ? stage.error(stage.render(unfiltered({{"caster_faces", "back"}})))
                                 : stage.error(stage.render(unfiltered({{"caster_faces", "front"}})));
    EXPECT_LT(right, 0.01);
    EXPECT_GT(wrong, 0.05);
  }
}

TEST(ShadowMap, BackFacesNeedNoSlopeBiasOnClosedMeshes) {
  Stage stage(box_and_sphere(point_light({1, 5, 2})), width, height);
  const auto error = [&](const char* faces) {
    return stage.error(stage.render({{"pcf_kernel", int64_t{1}},
                                     {"slope_bias", 0.0},
                                     {"constant_bias", 0.0},
                                     {"caster_faces", faces},
                                     {"map_size", int64_t{1024}}}));
  };
  EXPECT_GT(error("front"), 0.1);  // acne
  EXPECT_LT(error("back"), 0.5 * error("front"));
}

// Slope bias of one texel is what planar receivers need, as the parameter's description says.
TEST(ShadowMap, SlopeBiasOfOneTexelEndsAcneOnPlanes) {
  Frame f;
  add_ground(f.geometry, 2);
  f.light = directional_light({-1, -0.35f, -0.4f});
  f.camera.eye = {0.3f, 2, 3}, f.camera.target = {0, 0, 0};
  Stage stage(std::move(f), width, height);
  const auto error = [&](double slope) {
    return stage.error(stage.render({{"pcf_kernel", int64_t{1}},
                                     {"slope_bias", slope},
                                     {"constant_bias", 1e-6},
                                     {"map_size", int64_t{128}}}));
  };
  EXPECT_GT(error(0), 0.2);
  EXPECT_EQ(error(1), 0);
}

TEST(ShadowMap, ReceiverPlaneBiasEndsAcneOfWideKernels) {
  Frame f;
  add_ground(f.geometry, 2);
  f.light = directional_light({-1, -0.35f, -0.4f});
  f.camera.eye = {0.3f, 2, 3}, f.camera.target = {0, 0, 0};
  Stage stage(std::move(f), width, height);
  for (const char* pattern : {"grid", "poisson"}) {
    const ParamValues given{{"pcf_kernel", int64_t{9}},
                            {"slope_bias", 0.0},
                            {"constant_bias", 2e-5},
                            {"map_size", int64_t{128}},
                            {"pcf_pattern", pattern}};
    EXPECT_GT(stage.error(stage.render(given)), 0.1);
    ParamValues with = given;
    with["receiver_plane_bias"] = true;
    EXPECT_LT(stage.error(stage.render(with)), 1e-3);
  }
}

TEST(ShadowMap, CoarserDepthFormatsAreWorseUnderALowBias) {
  Frame f = box_and_sphere(directional_light({-0.010f, -1, 0.013f}));
  add_quad(f.geometry, {6, -90, 6}, {1, 0, 0}, {0, 0, 1});  // a long depth range
  Stage stage(std::move(f), width, height);
  const auto error = [&](const char* format) {
    return stage.error(stage.render({{"depth_format", format},
                                     {"fit", "none"},
                                     {"pcf_kernel", int64_t{1}},
                                     {"map_size", int64_t{4096}},
                                     {"constant_bias", 1e-6},
                                     {"slope_bias", 1.0}}));
  };
  EXPECT_LT(error("d32"), 0.5 * error("d16"));
  EXPECT_LE(error("d24"), error("d16"));
  EXPECT_LT(std::abs(error("d24") - error("d32")), 0.01);
}

// A kernel is the mean of its taps: the k x k filter of a map equals the mean of unfiltered lookups of
// receivers moved by whole texels, hence takes k * k + 1 values and turns a straight edge into a ramp k
// texels wide.
TEST(ShadowMap, KernelTurnsAnEdgeIntoARampAsWideAsItself) {
  Frame f;
  add_ground(f.geometry, 2);
  add_quad(f.geometry, {-2, 1, 2}, {2, 0, 0}, {0, 0, -4});  // covers x < 0
  f.light = directional_light({0, -1, 0});
  f.camera.eye = {0.1f, 0.9f, 0.01f}, f.camera.target = {0.1f, 0, 0}, f.camera.vertical_fov_degrees = 50;
  Stage stage(std::move(f), 127, 63);
  for (int64_t k : {3, 7}) {
    // An axis-aligned map (stable fit's frame does not turn with the camera).
    const Rendered r = stage.render({{"pcf_kernel", k}, {"map_size", int64_t{64}}, {"fit", "none"}});
    const double texel = 4 / (64 - 2 * (0.5 * double(k) + 1));
    const ViewSamplesHost& view = stage.view.host();
    int levels = 0;
    for (std::size_t i = 0; i < stage.pixels(); ++i) {
      if (!stage.reference().evaluated[i] || view.position[i].y > 0.5f) continue;
      const double x = view.position[i].x, v = double(r.visibility[i]);
      EXPECT_NEAR(v * double(k), std::round(v * double(k)), 1e-5);
      // Nearest texel centres are at most half a texel off, at the edge and at the receiver.
      EXPECT_NEAR(v, std::clamp(0.5 + x / (double(k) * texel), 0.0, 1.0), 1.001 / double(k)) << x;
      levels += v > 0 && v < 1;
    }
    EXPECT_GT(levels, 100);
  }
}

TEST(ShadowMap, PoissonDiscApproachesTheGridOfItsSize) {
  Stage stage(box_and_sphere(point_light({1, 5, 2})), width, height);
  const Rendered grid = stage.render({{"pcf_kernel", int64_t{7}}, {"slope_bias", 7.0}});
  const auto difference = [&](int64_t samples, bool rotate) {
    return stage.error(stage
                           .render({{"pcf_kernel", int64_t{7}},
                                    {"slope_bias", 7.0},
                                    {"pcf_pattern", "poisson"},
                                    {"poisson_samples", samples},
                                    {"poisson_rotation", rotate}})
                           .visibility,
                       grid.visibility);
  };
  EXPECT_LT(difference(64, false), 0.01);
  EXPECT_LT(difference(64, true), 0.01);
  EXPECT_LT(difference(64, false), difference(4, false));
}

TEST(ShadowMap, DiscPointsFillTheUnitDisc) {
  const std::vector<Vec2f> points = shadow_map::disc_points(64);
  double radius = 0, nearest = 9;
  for (std::size_t i = 0; i < points.size(); ++i) {
    radius = std::max(radius, std::hypot(double(points[i].x), double(points[i].y)));
    for (std::size_t j = 0; j < i; ++j)
      nearest =
          std::min(nearest, std::hypot(double(points[i].x - points[j].x), double(points[i].y - points[j].y)));
  }
  EXPECT_LE(radius, 1);
  EXPECT_GT(radius, 0.95);
  EXPECT_GT(nearest, 0.12);  // 64 random points come as close as 0.02
}

}  // namespace
}  // namespace penumbra::test
