#include "fixtures.h"
#include "scene/camera.h"
#include "scene/light.h"

namespace penumbra::test {
namespace {

Light rectangle() {
  Light l;
  l.kind = LightKind::rectangle;
  l.name = "key";
  l.center = {1, 2, 3};
  l.edge_u = {3, 0, 0};
  l.edge_v = {0, 0, 4};
  l.direction = {0, -1, 0};
  return l;
}

TEST(Light, SizeIsTheDiagonalOfARectangleAndTheDiameterOfASphere) {
  EXPECT_FLOAT_EQ(rectangle().size(), 5);
  Light s;
  s.kind = LightKind::sphere;
  s.radius = 0.75f;
  EXPECT_FLOAT_EQ(s.size(), 1.5f);
  EXPECT_EQ(Light{}.size(), 0);
}

TEST(Light, WithSizeKeepsCentreAndShape) {
  const Light l = with_size(rectangle(), 10);
  EXPECT_EQ(l.center, rectangle().center);
  EXPECT_EQ(l.edge_u, (Vec3f{6, 0, 0}));
  EXPECT_EQ(l.edge_v, (Vec3f{0, 0, 8}));
  EXPECT_FLOAT_EQ(l.size(), 10);
}

TEST(Light, SizeZeroIsAPointAtTheCentre) {
  const Light l = with_size(rectangle(), 0);
  EXPECT_EQ(l.kind, LightKind::point);
  EXPECT_EQ(l.center, rectangle().center);
  EXPECT_EQ(l.size(), 0);
}

TEST(Light, SizesThatCannotBeAreRefused) {
  EXPECT_CONTAINS(input_error_of([] { with_size(rectangle(), -1); }), "'key'");
  EXPECT_CONTAINS(input_error_of([] { with_size(rectangle(), NAN); }), "not a length");
  EXPECT_CONTAINS(input_error_of([] { with_size(Light{}, 1); }), "point light, which has no size");
  EXPECT_EQ(with_size(Light{}, 0), Light{});
}

TEST(Light, RectangleSpansItsEdges) {
  EXPECT_EQ(rectangle().at(0, 0), (Vec3f{-0.5f, 2, 1}));
  EXPECT_EQ(rectangle().at(1, 1), (Vec3f{2.5f, 2, 5}));
}

Camera camera() {
  Camera c;
  c.eye = {1, 2, 3}, c.target = {-2, 1, -5};
  c.vertical_fov_degrees = 50;
  c.near_plane = 0.1f;
  return c;
}

TEST(Camera, BasisIsRightHandedAndUnit) {
  const Camera::Basis b = camera().basis();
  EXPECT_NEAR(length(b.right), 1, 1e-12);
  EXPECT_NEAR(length(b.up), 1, 1e-12);
  EXPECT_NEAR(dot(cross(b.right, b.up), b.forward), -1, 1e-12);  // right x up points to the viewer
  EXPECT_GT(b.up.y, 0);
}

// The picture's two definitions, by matrix and by ray, hold the same point on the same pixel.
TEST(Camera, PointAlongAPixelsRayProjectsOntoThatPixel) {
  const Camera c = camera();
  const int w = 320, h = 200;
  const Mat4d clip = c.clip_from_world(w, h);
  for (const Vec2d pixel : {Vec2d{0, 0}, Vec2d{319.5, 0.5}, Vec2d{100.25, 150.75}, Vec2d{160, 100}})
    for (const double t : {0.1, 1.0, 250.0}) {
      const Vec3d p = Vec3d(c.eye) + c.ray_direction(pixel.x, pixel.y, w, h) * t;
      const Vec4d q = clip * Vec4d{p.x, p.y, p.z, 1};
      EXPECT_NEAR((q.x / q.w + 1) / 2 * w, pixel.x, 1e-8);
      EXPECT_NEAR((q.y / q.w + 1) / 2 * h, pixel.y, 1e-8);
      EXPECT_NEAR(q.w, t, 1e-9 * t);                           // forward component of the ray is 1
      EXPECT_NEAR(q.z / q.w, double{c.near_plane} / t, 1e-9);  // reversed: 1 at the near plane, 0 at infinity
    }
}

TEST(Camera, RowZeroIsOnTop) {
  const Camera c = camera();
  EXPECT_GT(c.ray_direction(50, 0, 100, 100).y, c.ray_direction(50, 100, 100, 100).y);
}

TEST(Camera, FieldOfViewIsVertical) {
  const Camera c = camera();
  const Vec3d top = normalize(c.ray_direction(400, 0, 800, 100)),
              bottom = normalize(c.ray_direction(400, 100, 800, 100));
  EXPECT_NEAR(std::acos(dot(top, bottom)) * 180 / 3.14159265358979, 50, 1e-6);
}

}  // namespace
}  // namespace penumbra::test
