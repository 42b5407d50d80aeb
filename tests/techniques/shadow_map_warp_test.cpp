// Warps and cascades: their formulas, and that they do what they are for.
#include "shadow_map_scenes.h"
#include "techniques/common/shadow_maps/warp.h"
#include "tests/support/brute_force.h"

namespace penumbra::test {
namespace {

using namespace shadow_map;

constexpr int width = 161, height = 97;

// A long road with posts, seen along it from near the ground.
Frame long_view(const Light& light) {
  Frame f;
  add_quad(f.geometry, {-6, 0, 4}, {12, 0, 0}, {0, 0, -104});
  for (int i = 0; i < 24; ++i) {
    const float z = 1 - 4.1f * float(i), x = i % 2 ? 1.1f : -1.3f;
    add_box(f.geometry, {x - 0.2f, 0, z - 0.2f}, {x + 0.2f, 1.5f, z + 0.2f});
  }
  f.light = light;
  f.camera.eye = {0.1f, 1.3f, 3.6f}, f.camera.target = {0, 0.6f, -10};
  return f;
}

ParamValues plain(std::initializer_list<ParamValues::value_type> more = {}) {
  ParamValues v{
      {"pcf_kernel", int64_t{1}}, {"slope_bias", 1.5}, {"constant_bias", 2e-6}, {"map_size", int64_t{256}}};
  for (const auto& m : more) v[m.first] = m.second;
  return v;
}

const Light side = directional_light({-0.8f, -1, 0.1f});

WarpInput road_input(const Light& light) {
  WarpInput in;
  const Frame f = long_view(light);
  in.light = light_point(light), in.camera = f.camera, in.width = width, in.height = height, in.room = 0.1;
  const Vec3d forward = in.light.at_infinity() ? in.light.axis : Vec3d{0, 0, -40} - in.light.towards.xyz();
  const auto frame = view_aligned(in.light, forward, f.camera, 1, 100);
  EXPECT_TRUE(frame.has_value());
  in.light_from_world = light_from_world(in.light, *frame);
  const double tan_y = std::tan(22.5 * std::numbers::pi / 180), tan_x = tan_y * width / height;
  const Camera::Basis b = f.camera.basis();
  for (double z : {2.0, 100.0})
    for (double x : {-tan_x, tan_x})
      for (double y : {-tan_y, 0.0}) {
        const Vec4d p = in.light_from_world * [&] {
          const Vec3d q = Vec3d(f.camera.eye) + (b.forward + b.right * x + b.up * y) * z;
          return Vec4d{q.x, q.y, q.z, 1};
        }();
        in.extent.extend(p.xyz() / p.w);
      }
  in.extent.view_lo = 2, in.extent.view_hi = 100;
  return in;
}

Vec3d project(const Mat4d& m, Vec3d p) {
  const Vec4d v = m * Vec4d{p.x, p.y, p.z, 1};
  return v.xyz() / v.w;
}

class EachWarp : public ::testing::TestWithParam<std::pair<const char*, Warp>> {};
INSTANTIATE_TEST_SUITE_P(ShadowMap, EachWarp,
                         ::testing::Values(std::pair{"psm", Warp::psm}, std::pair{"tsm", Warp::tsm},
                                           std::pair{"lispsm", Warp::lispsm}, std::pair{"log", Warp::log}),
                         [](const auto& i) { return i.param.first; });

TEST_P(EachWarp, KeepsLightRaysAndTheirOrder) {
  for (const Light& light : {side, directional_light({0.3f, -1, 0.5f}), point_light({-4, 20, -30})}) {
    const WarpInput in = road_input(light);
    const auto w = warp(GetParam().second, in, 1, 0.2);
    ASSERT_TRUE(w.has_value());
    const Mat4d m = *w * in.light_from_world;
    for (const Vec3d p : {Vec3d{0.3, 0, -2}, Vec3d{-1, 0.5, -20}, Vec3d{2, 0, -70}}) {
      const Vec3d along = in.light.at_infinity() ? in.light.axis : (p - in.light.towards.xyz()) * 0.1;
      Vec3d before = project(m, p);
      for (double t : {0.5, 1.0, 3.0}) {
        const Vec3d q = project(m, p + along * t);
        EXPECT_NEAR(q.x, before.x, 1e-9 * (1 + std::abs(q.x)));
        EXPECT_NEAR(q.y, before.y, 1e-9 * (1 + std::abs(q.y)));
        EXPECT_GT(q.z, before.z);
        before = q;
      }
    }
  }
}

TEST_P(EachWarp, DoesNotMirrorTheMap) {
  const WarpInput in = road_input(side);
  const Mat4d m = *warp(GetParam().second, in, 1, 0.2) * in.light_from_world;
  const LightFrame f = *view_aligned(in.light, in.light.axis, in.camera, 1, 100);
  const Vec3d p{0, 0, -10}, a = project(m, p), b = project(m, p + f.right), c = project(m, p + f.down);
  EXPECT_GT((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0);
}

// Closed forms of the sources.
TEST(Warps, LispsmDistanceIsThePapers) {
  // n_opt = (z_n + sqrt(z_n z_f)) / sin(gamma), d = (z_f - z_n) / sin(gamma) [Wimmer2004]
  for (double sine : {1.0, 0.5, 0.1}) {
    const double zn = 2, zf = 72;
    EXPECT_NEAR(lispsm_distance(zn, zf, (zf - zn) / sine), (zn + std::sqrt(zn * zf)) / sine, 1e-9);
  }
}

TEST(Warps, TrapezoidPutsItsFocusOnTheEightyPercentLine) {
  const double d = 7, focus = 1.5, xi = -0.6, n = tsm_distance(focus, d, xi);
  // The perspective a + b / (y + n) that takes the near edge to 1 and the far edge to -1.
  const double b = 2 / (1 / n - 1 / (d + n)), a = 1 - b / n;
  EXPECT_NEAR(a + b / (focus + n), xi, 1e-12);
}

TEST(Warps, LogarithmicMapGivesEqualRatiosEqualTexels) {
  const double z0 = 2, z1 = 32, d = 30, n = log_distance(z0, z1, d);
  EXPECT_NEAR((n + d) / n, z1 / z0, 1e-12);
}

// With the light at right angles to the view, a perspective map's centre is the eye: its divisor is view
// depth.
TEST(Warps, PsmDividesByViewDepthWhenTheLightIsAtRightAngles) {
  Frame f = long_view(directional_light({0, -1, 0}));
  f.camera.target = {0.1f, 1.3f, -10};  // level
  WarpInput in = road_input(directional_light({0, -1, 0}));
  in.camera = f.camera;
  in.light_from_world = light_from_world(in.light, *view_aligned(in.light, in.light.axis, f.camera, 1, 100));
  const Mat4d m = *warp(Warp::psm, in, 1, 0.2) * in.light_from_world;
  const auto w = [&](Vec3d p) { return (m * Vec4d{p.x, p.y, p.z, 1}).w; };
  const double one = w({0.1, 0, 3.6 - 1});
  for (double depth : {3.0, 10.0, 50.0}) EXPECT_NEAR(w({2, 0.4, 3.6 - depth}) / one, depth, 1e-6 * depth);
}

TEST(Warps, FallBackWhereViewAndLightAlign) {
  const Light light = directional_light({0, -0.05f, -1});
  Frame f = long_view(light);
  f.camera.eye = {0, 3, 4}, f.camera.target = {0, 2.5f, -6};
  Stage stage(std::move(f), width, height);
  for (const char* w : {"psm", "tsm", "lispsm", "log"}) {
    const Rendered r = stage.render(plain({{"warp", w}}));
    if (number(r.counters, "warped_layers") == 0) {
      EXPECT_EQ(r.visibility, stage.render(plain()).visibility) << w;
    }
  }
  Frame g = long_view(directional_light({0, -0.1f, -2}));
  g.camera.eye = {0, 3, 4}, g.camera.target = {0, 2.5f, -6};
  Stage aligned(std::move(g), width, height);
  EXPECT_EQ(number(aligned.render(plain({{"warp", "lispsm"}})).counters, "warped_layers"), 0);
}

// Above the road, near enough to see its ends far apart. Not over its middle: from there the posts' sides are
// slivers narrower than any texel, whose acne is all there is to see.
const Light overhead = point_light({9, 30, -30});

TEST_P(EachWarp, BeatsNoneOnALongView) {
  for (const Light& light : {side, point_light({-80, 100, -50}), overhead}) {
    Stage stage(long_view(light), width, height);
    const Rendered warped = stage.render(plain({{"warp", GetParam().first}})), none = stage.render(plain());
    EXPECT_EQ(number(warped.counters, "warped_layers"), 1);
    EXPECT_LT(stage.error(warped), 0.75 * stage.error(none));
  }
}

void differs_only_near_edges(const Light& light, const char* kind) {
  Stage stage(long_view(light), width, height);
  const double constant = 2e-6 * double(stage.frame.geometry.bounds.diagonal());
  const ParamValues given = plain({{"map_size", int64_t{128}}, {"warp", kind}});
  const Rendered r = stage.render(given);
  const FittedLayer layer = stage.fit(given).layers[0];
  const testing::BruteForce truth(stage.frame.geometry);
  int differing = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    if (!stage.reference().evaluated[i] || r.visibility[i] == stage.reference().visibility[i]) continue;
    ++differing;
    const Vec3d p(stage.view.host().origin[i].xyz());
    // A texel's diagonal in the world, at right angles to the light: the inverse of the map's derivative.
    const Vec3d a = map_point(layer, p), b = map_point(layer, p + layer.frame.right * 1e-4),
                c = map_point(layer, p + layer.frame.down * 1e-4);
    const Vec2d x{(b.x - a.x) / 1e-4, (b.y - a.y) / 1e-4}, y{(c.x - a.x) / 1e-4, (c.y - a.y) / 1e-4};
    const double det = x.x * y.y - x.y * y.x, norm = std::sqrt(x.x * x.x + x.y * x.y + y.x * y.x + y.y * y.y);
    const double texel = 2.0 / 128 * norm / std::abs(det);  // not below the longest side
    const double reach =
        1.2 * (std::numbers::sqrt2 / 2 + 1.5) * texel + constant;  // texels vary within a few
    EXPECT_LE(truth.explain(p, light_point(light).towards, no_triangle, reach).distance, reach) << kind << i;
  }
  EXPECT_GT(differing, 3);
}

TEST_P(EachWarp, DiffersOnlyWithinTexelAndBiasOfAnEdge) {
  for (const Light& light : {side, overhead}) differs_only_near_edges(light, GetParam().first);
}

TEST(ShadowMap, LogarithmicMapsKnowTheSidesOfCasters) {
  Frame f = long_view(side);
  f.geometry = {};
  add_quad(f.geometry, {-6, 0, 4}, {12, 0, 0}, {0, 0, -104});
  add_quad(f.geometry, {0, 1, -2}, {1, 0, 0}, {0, 0, -1});  // faces up, towards the light
  Stage stage(std::move(f), width, height);
  const auto error = [&](const char* faces) {
    return stage.error(stage.render(plain({{"warp", "log"}, {"caster_faces", faces}})));
  };
  EXPECT_LT(error("front"), 0.3 * error("back"));
  EXPECT_EQ(error("front"), error("both"));
}

TEST(ShadowMap, CascadesBeatOneMap) {
  for (const Light& light : {side, spot_light({-25, 40, -40}, {0, 0, -40}, 55)})
    for (const char* fit : {"tight", "stable"}) {
      Stage stage(long_view(light), width, height);
      const double one = stage.error(stage.render(plain({{"fit", fit}})));
      for (const char* split : {"log", "practical"})
        EXPECT_LT(stage.error(stage.render(
                      plain({{"fit", fit}, {"cascades", int64_t{4}}, {"cascade_split", split}}))),
                  0.5 * one)
            << fit << " " << split;
      EXPECT_LT(stage.error(stage.render(
                    plain({{"fit", fit}, {"cascades", int64_t{8}}, {"cascade_split", "uniform"}}))),
                one);
    }
}

TEST(ShadowMap, CascadesAndWarpsCombine) {
  Stage stage(long_view(side), width, height);
  const double two = stage.error(stage.render(plain({{"cascades", int64_t{2}}, {"map_size", int64_t{128}}})));
  const Rendered both =
      stage.render(plain({{"cascades", int64_t{2}}, {"map_size", int64_t{128}}, {"warp", "lispsm"}}));
  EXPECT_EQ(number(both.counters, "warped_layers"), 2);
  EXPECT_LT(stage.error(both), two);
}

TEST(ShadowMap, SplitsAreReportedFromTheViewSamplesDepths) {
  Stage stage(long_view(side), width, height);
  const Rendered r = stage.render(plain({{"cascades", int64_t{3}}, {"cascade_split", "uniform"}}));
  const auto& splits = std::get<std::vector<double>>(r.counters.at("cascade_splits"));
  ASSERT_EQ(splits.size(), 4u);
  double lo = 1e9, hi = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i)
    if (const Vec4f p = stage.view.host().position[i];
        p.w > 0 && dot(stage.view.host().geometric_normal[i].xyz(), stage.frame.light.direction) < 0)
      lo = std::min(lo, double(p.w)), hi = std::max(hi, double(p.w));
  EXPECT_NEAR(splits[0], lo, 1e-4);
  EXPECT_NEAR(splits[3], hi, 1e-3);
  EXPECT_NEAR(splits[1] - splits[0], splits[2] - splits[1], 1e-9);
}

TEST(ShadowMap, SaysWhatDoesNotCombine) {
  Stage stage(long_view(side), width, height);
  const auto reason = [&](const ParamValues& v) { return stage.supports(v).value_or(""); };
  EXPECT_NE(reason({{"warp", "lispsm"}, {"fit", "stable"}}).find("fit tight"), std::string::npos);
  EXPECT_NE(reason({{"cascades", int64_t{2}}, {"fit", "none"}}).find("tight or stable"), std::string::npos);
  EXPECT_NE(reason({{"filter", "pcss"}}).find("rectangle or sphere"), std::string::npos);
  EXPECT_EQ(reason({{"warp", "log"}, {"cascades", int64_t{3}}, {"filter", "msm"}}), "");
  Stage inside(long_view(rectangle_light({0, 1, -4}, 0.2f, 0.2f)), 31, 31);
  EXPECT_NE(inside.supports({{"warp", "tsm"}}).value_or("").find("six faces"), std::string::npos);
  EXPECT_NE(inside.supports({{"warp", "tsm"}, {"filter", "pcss"}}).value_or("").find("bends"),
            std::string::npos);
  EXPECT_EQ(inside.supports({{"filter", "pcss"}}).value_or(""), "");
  EXPECT_NE(inside.supports({{"filter", "evsm"}, {"moment_format", "bits16"}}).value_or("").find("5.54"),
            std::string::npos);
}

// A lamp low above the scene lies outside its bounds, which supports() asks for; only the view samples show
// that they lie to all sides of it.
TEST(ShadowMap, LightWithViewSamplesOnAllSidesTakesNeitherWarpNorCascades) {
  Frame frame;
  add_ground(frame.geometry, 6);
  frame.light = point_light({0, 0.3f, 0});
  frame.camera.eye = {0, 6, 4}, frame.camera.target = {0, 0, 0};
  Stage stage(std::move(frame), 64, 48);
  for (const ParamValues& v : {ParamValues{{"warp", "lispsm"}}, ParamValues{{"cascades", int64_t{3}}}}) {
    EXPECT_EQ(stage.supports(v).value_or(""), "");
    EXPECT_THROW(stage.render(v), UnsupportedError);
  }
}

}  // namespace
}  // namespace penumbra::test
