// The fit's arithmetic against closed forms: no device.
#include <gtest/gtest.h>

#include "scene/light.h"
#include "techniques/common/shadow_maps/light_space.h"

namespace penumbra::shadow_map {
namespace {

Vec3d project(const Mat4d& m, Vec3d p) {
  const Vec4d v = m * Vec4d{p.x, p.y, p.z, 1};
  return v.xyz() / v.w;
}

LightPoint point_at(Vec3d p) {
  Light l;
  l.kind = LightKind::point, l.center = Vec3f(p);
  return light_point(l);
}

TEST(LightSpace, FrameIsRightHandedAndDownFollowsTheHint) {
  const LightFrame f = light_frame({0, -1, 0}, {0.3, -0.8, 0.1});
  EXPECT_NEAR(dot(cross(f.right, f.down), f.forward), 1, 1e-12);
  EXPECT_NEAR(dot(f.down, f.forward), 0, 1e-12);
  EXPECT_GT(dot(f.down, Vec3d{0.3, -0.8, 0.1}), 0);
  const LightFrame g = light_frame({0, -1, 0}, {0, 1, 0});
  EXPECT_NEAR(dot(cross(g.right, g.down), g.forward), 1, 1e-12);
}

TEST(LightSpace, LightRaysKeepTheirPlaceAndGrowInDepth) {
  const LightPoint light = point_at({1, 5, 2});
  const Mat4d m = light_from_world(light, light_frame({-0.2, -1, 0.1}, {0, 0, 1}));
  const Vec3d through{0.5, -1, 0.3};
  Vec3d before = project(m, Vec3d{1, 5, 2} + through);
  for (double t : {1.5, 2.0, 8.0}) {
    const Vec3d p = project(m, Vec3d{1, 5, 2} + through * t);
    EXPECT_NEAR(p.x, before.x, 1e-12);
    EXPECT_NEAR(p.y, before.y, 1e-12);
    EXPECT_GT(p.z, before.z);
    before = p;
  }
}

TEST(LightSpace, CropFillsTheMapUpToTheBorder) {
  Extent e;
  e.extend({-3, 2, 10}), e.extend({5, 4, 30});
  const Mat4d m = crop(e, 100, 10, 0);
  EXPECT_NEAR(project(m, {-3, 2, 10}).x, -0.8, 1e-12);
  EXPECT_NEAR(project(m, {5, 4, 30}).x, 0.8, 1e-12);
  EXPECT_NEAR(project(m, {5, 4, 30}).y, 0.8, 1e-12);
  EXPECT_GT(project(m, {0, 0, 10}).z, 0);
  EXPECT_LT(project(m, {0, 0, 30}).z, 1);
}

TEST(LightSpace, CropOfOnePointIsFinite) {
  Extent e;
  e.extend({2, 2, 2});
  const Vec3d p = project(crop(e, 64, 2, 0.1), {2, 2, 2});
  EXPECT_NEAR(p.x, 0, 1e-6);
  EXPECT_GT(p.z, 0);
  EXPECT_LT(p.z, 1);
}

// What makes the stable fit stable: moving what is covered moves the map by whole texels.
TEST(LightSpace, SnappedExtentsMoveByWholeTexels) {
  Extent a;
  a.extend({-1.03, -2.5, 0}), a.extend({2.1, 1.7, 1});
  const double map_size = 256, border = 2;
  const Extent s = snapped(a, map_size, border);
  for (double shift : {0.001, 0.0137, 0.4, 3.3}) {
    Extent b = a;
    b.lo.x += shift, b.hi.x += shift, b.lo.y -= shift, b.hi.y -= shift;
    const Extent t = snapped(b, map_size, border);
    for (int c = 0; c < 2; ++c) {
      const double texel = (s.hi[c] - s.lo[c]) / (map_size - 2 * border);
      EXPECT_NEAR(t.hi[c] - t.lo[c], s.hi[c] - s.lo[c], 1e-12);
      const double moved = (t.lo[c] - s.lo[c]) / texel;
      EXPECT_NEAR(moved, std::round(moved), 1e-9);
      EXPECT_LE(t.lo[c], b.lo[c]);
      EXPECT_GE(t.hi[c], b.hi[c]);
    }
  }
}

struct TestLayer {
  LightPoint light = point_at({0, 4, 0});
  FittedLayer fitted;
  MapLayer device;
  TestLayer() {
    fitted.frame = light_frame({0.1, -1, 0.2}, {0, 0, 1});
    Extent e;
    e.extend({-1, -1, -1 / 1.5}), e.extend({1, 1, -1 / 6.0});
    fitted.clip_from_world = crop(e, 512, 3, 0) * light_from_world(light, fitted.frame);
    device = make_layer(fitted, light, 512, {0.5, 0, 0}, {0, 0, 0.25});
  }
};

TEST(LightSpace, LayerUnprojectsToLinearDepth) {
  const TestLayer t;
  for (const Vec3d p : {Vec3d{0.5, 1, 0.2}, Vec3d{-0.4, 0, 0.7}, Vec3d{0, 2, 0}}) {
    const Vec3d c = project(t.fitted.clip_from_world, p);
    const Vec4d v{c.x, c.y, c.z, 1};
    const auto dot4 = [&](Vec4f a) {
      return double(a.x) * v.x + double(a.y) * v.y + double(a.z) * v.z + double(a.w) * v.w;
    };
    const double linear = dot4(t.device.linear_numerator) / dot4(t.device.linear_denominator);
    EXPECT_NEAR(linear, dot(t.fitted.frame.forward, p - Vec3d{0, 4, 0}), 1e-5);
    const Vec4f w = t.device.linear_from_world;
    EXPECT_NEAR(double(w.x) * p.x + double(w.y) * p.y + double(w.z) * p.z + double(w.w), linear, 1e-5);
  }
}

TEST(LightSpace, LayerTakesPlanesToTheirSlopeInTheMap) {
  const TestLayer t;
  const Vec3d n = normalize(Vec3d{0.3, 1, -0.2}), p{0.2, 0.5, 0.1}, along = cross(n, Vec3d{1, 0, 0});
  const Vec4f plane{float(n.x), float(n.y), float(n.z), float(-dot(n, p))};
  const Vec4f s = t.device.plane_from_world * plane;
  const Vec3d a = project(t.fitted.clip_from_world, p),
              b = project(t.fitted.clip_from_world, p + along * 0.3);
  EXPECT_NEAR(b.z - a.z, -(double(s.x) * (b.x - a.x) + double(s.y) * (b.y - a.y)) / double(s.z), 1e-6);
}

// The light's edge, seen from a receiver at distance r through a plane at distance b, spans edge (1 / b - 1 /
// r) of tangent: what light_texels turns into texels.
TEST(LightSpace, LayerKnowsTheLightsEdgesInTexels) {
  const TestLayer t;
  const Vec3d axis = t.fitted.frame.forward, center{0, 4, 0}, edge{0.5, 0, 0};
  const Vec3d flat = edge - axis * dot(edge, axis), receiver = center + axis * 5.0;
  const double b = 2, r = 5;
  // Where the segments from the receiver to the light's ends meet the plane at distance b.
  const auto through = [&](double s) { return receiver + (center + flat * s - receiver) * ((r - b) / r); };
  const Vec3d p = map_point(t.fitted, through(-0.5)), q = map_point(t.fitted, through(0.5));
  EXPECT_NEAR(256 * (q.x - p.x), double(t.device.light_texels.x) * (1 / b - 1 / r), 1e-4);
  EXPECT_NEAR(256 * (q.y - p.y), double(t.device.light_texels.y) * (1 / b - 1 / r), 1e-4);
}

TEST(Splits, AreUniformLogarithmicOrTheirBlend) {
  const std::vector<double> u = split_depths(Split::uniform, 0.5, 4, 1, 81);
  EXPECT_EQ(u, (std::vector<double>{1, 21, 41, 61, 81}));
  const std::vector<double> l = split_depths(Split::log, 0.5, 4, 1, 81);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(l[i], std::pow(3.0, double(i)), 1e-9);
  const std::vector<double> p = split_depths(Split::practical, 0.25, 4, 1, 81);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(p[i], 0.25 * l[i] + 0.75 * u[i], 1e-12);
}

TEST(LightSpace, BoxAroundTheLightHasNoSingleFrustum) {
  const LightPoint light = point_at({0, 0, 0});
  const Mat4d m = light_from_world(light, light_frame({0, -1, 0}, {0, 0, 1}));
  EXPECT_FALSE(extent_of({{-1, -1, -1}, {1, 1, 1}}, m, widest_tangent).has_value());
  EXPECT_TRUE(extent_of({{-1, -2, -1}, {1, -1, 1}}, m, widest_tangent).has_value());
}

}  // namespace
}  // namespace penumbra::shadow_map
