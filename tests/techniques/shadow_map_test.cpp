// The depth map and its fit against Embree and closed forms.
#include <cstring>

#include "shadow_map_scenes.h"
#include "techniques/common/shadow_maps/counters.h"
#include "techniques/common/shadow_maps/depth_maps.h"
#include "tests/support/brute_force.h"

namespace penumbra::test {
namespace {

constexpr int width = 161, height = 119;  // odd and not square

class EachLight : public ::testing::TestWithParam<Light> {};

INSTANTIATE_TEST_SUITE_P(ShadowMap, EachLight,
                         ::testing::Values(point_light({1, 5, 2}), directional_light({-0.3f, -1, -0.4f}),
                                           spot_light({1, 5, 2}, {0, 0, 0}, 35),
                                           rectangle_light({1, 5, 1}, 0.8f, 0.5f),
                                           point_light({0, 1.5f, 0.9f})),
                         [](const auto& i) {
                           return std::string(to_string(i.param.kind)) + std::to_string(i.index);
                         });

TEST_P(EachLight, ErrorFallsAsTheMapGrows) {
  Stage stage(box_and_sphere(GetParam()), width, height);
  double before = 1;
  for (int64_t size : {32, 128, 512}) {
    const double e = stage.error(stage.render(unfiltered({{"map_size", size}})));
    EXPECT_LT(e, 0.6 * before) << size;
    before = e;
  }
  EXPECT_LT(before, 0.001);
}

TEST_P(EachLight, TightFitBeatsNone) {
  Frame f = box_and_sphere(GetParam());
  add_ground(f.geometry, 30, -0.1f);
  // The camera sees a small part of a large scene; a spot's map never covers more than its cone.
  f.camera.eye = {0.5f, 3, 3}, f.camera.target = {0.3f, 0, 0}, f.camera.vertical_fov_degrees = 30;
  Stage stage(std::move(f), width, height);
  double tight = 0, none = 0;  // over several sizes: one may happen to meet the edges well
  for (int64_t size : {40, 57, 80, 113}) {
    const Rendered a = stage.render(unfiltered({{"map_size", size}}));
    const Rendered b = stage.render(unfiltered({{"map_size", size}, {"fit", "none"}}));
    EXPECT_LT(number(a.counters, "texel_to_pixel_median"), number(b.counters, "texel_to_pixel_median"));
    tight += stage.error(a), none += stage.error(b);
  }
  EXPECT_LT(tight, 0.9 * none);
}

TEST_P(EachLight, StableFitIsRightToo) {
  Stage stage(box_and_sphere(GetParam()), width, height);
  EXPECT_LT(stage.error(stage.render(unfiltered({{"map_size", int64_t{2048}}, {"fit", "stable"}}))), 0.006);
}

// Where an unfiltered map differs from the truth, the segment to the light passes an edge of a caster within
// what the map's texel and the bias can move it: half a texel's diagonal, and slope_bias texels (a caster
// pushed along the light by n times what its plane gains per texel is one moved sideways by n texels).
TEST_P(EachLight, DiffersOnlyWithinTexelAndBiasOfAnEdge) {
  Stage stage(box_and_sphere(GetParam()), width, height);
  const double slope_bias = 1.5, constant_bias = 2e-5 * double(stage.frame.geometry.bounds.diagonal());
  const ParamValues given = unfiltered({{"map_size", int64_t{256}}});
  const Rendered r = stage.render(given);
  const shadow_map::Fitted fitted = stage.fit(given);
  const testing::BruteForce truth(stage.frame.geometry);
  const ViewSamplesHost& view = stage.view.host();
  int differing = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    if (!stage.reference().evaluated[i] || r.visibility[i] == stage.reference().visibility[i]) continue;
    ++differing;
    const Vec3d p(view.origin[i].xyz());
    // The largest texel of any layer, at the receiver's distance (as wide as it gets between light and
    // receiver).
    double texel = 0;
    for (const shadow_map::FittedLayer& l : fitted.layers) {
      if (!l.used) continue;
      const double w = fitted.light.at_infinity()
                           ? 1
                           : std::max(0.0, dot(l.frame.forward, p - fitted.light.towards.xyz()));
      texel = std::max(
          texel, w * std::max(l.extent.hi.x - l.extent.lo.x, l.extent.hi.y - l.extent.lo.y) / (256 - 3));
    }
    const double reach = (std::numbers::sqrt2 / 2 + slope_bias) * texel + constant_bias;
    const testing::Tie tie = truth.explain(p, fitted.light.towards, no_triangle, reach);
    EXPECT_LE(tie.distance, reach) << i << (tie.blocked ? " blocked" : " lit");
  }
  EXPECT_GT(differing, 3);
}

// While the camera moves, a stable map's texels keep their places on what stands still; a tight one's do not.
TEST_P(EachLight, StableFitKeepsItsTexelsWhileTheCameraMoves) {
  const Vec3d fixed{0.3, 0, 0.4};
  double worst = 0, worst_tight = 0;
  std::vector<Vec2d> before, before_tight;
  const auto moved = [](const std::vector<Vec2d>& a, const std::vector<Vec2d>& b) {
    double off = 0;  // from whole texels
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      for (double d : {b[i].x - a[i].x, b[i].y - a[i].y}) off = std::max(off, std::abs(d - std::round(d)));
    return off;
  };
  for (int step = 0; step < 4; ++step) {
    Frame f = box_and_sphere(GetParam());
    f.camera.eye.x += 0.013f * float(step);
    f.camera.target.x += 0.013f * float(step);
    Stage stage(std::move(f), width, height);
    const auto texels = [&](const char* fit) {
      std::vector<Vec2d> at;
      for (const shadow_map::FittedLayer& l :
           stage.fit(unfiltered({{"map_size", int64_t{256}}, {"fit", fit}})).layers) {
        const Vec3d m = shadow_map::map_point(l, fixed);
        if (l.used && std::isfinite(m.x)) at.push_back({128 * m.x, 128 * m.y});
      }
      return at;
    };
    const std::vector<Vec2d> now = texels("stable"), now_tight = texels("tight");
    if (step > 0) {
      worst = std::max(worst, moved(before, now));
      worst_tight = std::max(worst_tight, moved(before_tight, now_tight));
    }
    before = now, before_tight = now_tight;
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(worst_tight, 0.02);
}

TEST(ShadowMap, LightAmongTheViewSamplesTakesSixFaces) {
  Stage inside(box_and_sphere(point_light({0, 1.5f, 0.9f})), width, height);
  EXPECT_EQ(number(inside.render(unfiltered()).counters, "six_faces"), 1);
  Stage outside(box_and_sphere(point_light({1, 5, 2})), width, height);
  EXPECT_EQ(number(outside.render(unfiltered()).counters, "six_faces"), 0);
}

TEST(ShadowMap, UnfilteredLookupIsTheComparisonWithTheNearestTexel) {
  Stage stage(box_and_sphere(point_light({1, 5, 2})), width, height);
  const ParamValues given = unfiltered({{"map_size", int64_t{333}}});
  const shadow_map::Params params = stage.params(given);
  shadow_map::Fitter fitter(params);
  shadow_map::DepthMaps maps(params);
  fitter.setup(device()), maps.setup(device());
  const shadow_map::Fitted& fitted =
      fitter.run(stage.the_case, light_point(stage.frame.light), stage.view, stage.passes);
  maps.draw(stage.the_case, fitted, stage.passes);
  gpu::Buffer texels(device(), 333 * 333 * sizeof(float), gpu::Memory::read_back, "texels");
  stage.passes.device_pass("copy", [&](gpu::Commands& c) {
    c.copy_image_to_buffer(maps.image(), texels, VK_IMAGE_ASPECT_DEPTH_BIT);
  });
  stage.passes.finish();
  const std::span<float> depth = texels.view<float>();
  const Rendered r = stage.render(given);
  const ViewSamplesHost& view = stage.view.host();
  int compared = 0, ties = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    if (!stage.reference().evaluated[i]) continue;
    const Vec3d p(view.origin[i].xyz()), to_light = fitted.light.towards.xyz() - p;
    const Vec3d moved = p + normalize(to_light) * (2e-5 * double(stage.frame.geometry.bounds.diagonal()));
    const Vec4d clip = fitted.layers[0].clip_from_world * Vec4d{moved.x, moved.y, moved.z, 1};
    const double x = (clip.x / clip.w * 0.5 + 0.5) * 333, y = (clip.y / clip.w * 0.5 + 0.5) * 333,
                 z = clip.z / clip.w;
    const double stored = double(
        depth[static_cast<std::size_t>(std::floor(y)) * 333 + static_cast<std::size_t>(std::floor(x))]);
    // Float rounding in the shader may move a receiver over a texel's edge or a depth.
    if (std::abs(x - std::round(x)) < 1e-3 || std::abs(y - std::round(y)) < 1e-3 ||
        std::abs(z - stored) < 2e-6) {
      ++ties;
      continue;
    }
    ++compared;
    EXPECT_EQ(r.visibility[i], z <= stored ? 1.0f : 0.0f) << i;
  }
  EXPECT_GT(compared, 4000);
  EXPECT_LT(ties, compared / 20);
}

TEST(ShadowMap, EdgeOfABoxFallsWithinATexel) {
  Frame f;
  add_ground(f.geometry, 2);
  add_box(f.geometry, {-0.5f, 0.5f, -0.5f}, {0.5f, 0.75f, 0.5f});
  f.light = point_light({0, 4, 0});
  f.camera.eye = {3, 1.0f, 0.01f}, f.camera.target = {0.5f, 0, 0};
  Stage stage(std::move(f), width, height);
  const Rendered r = stage.render(unfiltered({{"map_size", int64_t{512}}, {"fit", "none"}}));
  // The box's top edge at (0.5, 0.75) throws its shadow to 0.5 * 4 / 3.25.
  const double edge = 0.5 * 4 / (4 - 0.75);
  // Frustum of the scene's bounds from the light: |x / w| <= 2 / (4 - 0.75), the box's corners do not reach
  // further.
  const double texel = 4 * 2 * (2 / 3.25) / (512 - 3);
  int near_edge = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    const Vec4f p = stage.view.host().position[i];
    if (!stage.reference().evaluated[i] || std::abs(p.y) > 1e-4f) continue;
    const double from_edge = std::max(std::abs(double(p.x)), std::abs(double(p.z))) - edge;
    if (std::abs(from_edge) > 1.5 * texel)
      EXPECT_EQ(r.visibility[i], from_edge > 0 ? 1 : 0) << p.x << " " << p.z;
    else
      ++near_edge;
  }
  EXPECT_GT(near_edge, 3);
}

// The fit covers the view samples alone; what casts from outside is kept by depth clamp.
TEST(ShadowMap, CastersOutsideTheViewAreKept) {
  Frame f;
  add_ground(f.geometry, 2);
  add_quad(f.geometry, {-0.5f, 20, 0.5f}, {1, 0, 0}, {0, 0, -1});
  f.light = directional_light({0, -1, 0});
  f.camera.eye = {0, 1, 3}, f.camera.target = {0, 0, 0};
  Stage stage(std::move(f), width, height);
  double umbra = 0;
  for (float v : stage.reference().visibility) umbra += v == 0;
  EXPECT_GT(umbra, 500);
  EXPECT_LT(stage.error(stage.render(unfiltered())), 0.01);
}

TEST(ShadowMap, SpotLightIsDarkOutsideItsCone) {
  Stage stage(box_and_sphere(spot_light({1, 5, 2}, {0, 0, 0}, 12)), width, height);
  double lit = 0, dark = 0;
  for (float v : stage.reference().visibility) (v > 0 ? lit : dark) += 1;
  EXPECT_GT(dark, lit);
  EXPECT_LT(stage.error(stage.render(unfiltered({{"map_size", int64_t{1024}}}))), 0.004);
}

TEST(ShadowMap, SecondFrameAllocatesNothingAndIsTheSame) {
  Stage stage(box_and_sphere(point_light({1, 5, 2})), width, height);
  const std::unique_ptr<Technique> technique = stage.make({});
  technique->setup(stage.the_case, stage.passes);
  technique->build(stage.the_case, stage.passes);
  const Rendered first = stage.render(*technique);
  const uint64_t bytes = device().allocated_bytes();
  const Rendered second = stage.render(*technique);
  EXPECT_EQ(device().allocated_bytes(), bytes);
  EXPECT_EQ(first.visibility, second.visibility);
  EXPECT_GT(technique->structure_bytes(), 1024u * 1024 * 4);
  std::vector<std::string> names;
  for (const gpu::PassTime& p : second.passes) names.push_back(p.name);
  EXPECT_EQ(names, (std::vector<std::string>{"fit", "fit_samples", "fit_bounds", "depth_map", "lookup"}));
}

TEST(ShadowMap, SkyAloneRenders) {
  Frame f = box_and_sphere(point_light({1, 5, 2}));
  f.camera.eye = {0, 10, 0}, f.camera.target = {0, 20, 0.1f};
  Stage stage(std::move(f), width, height);
  const Rendered r = stage.render({});
  EXPECT_EQ(r.visibility.size(), stage.pixels());
}

// Looking straight down on the ground through a map of the same scale: one texel is one pixel times the
// ratio.
TEST(ShadowMap, TexelToPixelRatioIsTheGeometricOne) {
  Frame f;
  add_ground(f.geometry, 2);
  f.light = directional_light({0, -1, 0});
  f.camera.eye = {0, 10, 0}, f.camera.target = {0, 0, 0}, f.camera.up = {0, 0, -1};
  f.camera.vertical_fov_degrees = 10;
  Stage stage(std::move(f), 65, 65);
  const Rendered r = stage.render(unfiltered({{"fit", "none"}, {"map_size", int64_t{256}}}));
  const double pixel = 2 * 10 * std::tan(5 * std::numbers::pi / 180) / 65, texel = 4.0 / (256 - 3);
  EXPECT_NEAR(number(r.counters, "texel_to_pixel_median"), texel / pixel, 1e-3);
  EXPECT_NEAR(number(r.counters, "texel_to_pixel_p95"), texel / pixel, 1e-3);
}

}  // namespace
}  // namespace penumbra::test
