#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "gpu/device.h"
#include "samples/view_samples.h"
#include "tests/support/host_view.h"

namespace penumbra {
namespace {

Frame small_scene() {
  Frame frame;
  testing::add_ground(frame.geometry, 4);
  testing::add_box(frame.geometry, {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f});
  testing::add_soup(frame.geometry, {-2, 0.2f, -2}, {2, 2, 2}, 200, 0.4f, 7);
  frame.camera.eye = {2.5f, 2, 4}, frame.camera.target = {0, 0.5f, 0};
  return frame;
}

class ViewSamplesTest : public ::testing::Test {
 protected:
  gpu::Device device;
  gpu::PassRecorder passes{device};
  Frame frame = small_scene();
  GeometryOnDevice geometry;
  void SetUp() override { geometry.update(device, frame, passes); }
  void TearDown() override { EXPECT_TRUE(device.validation_messages().empty()); }
};

// How far P is from the ray through its pixel's centre, in pixels, and from its triangle's plane, in scene
// units.
struct Deviation {
  double pixels, plane;
};

Deviation deviation(const Frame& frame, const ViewSamplesHost& view, std::size_t i) {
  const auto w = static_cast<std::size_t>(view.width);
  const double x = double(i % w) + 0.5, y = double(i / w) + 0.5;
  const Vec3d d = frame.camera.ray_direction(x, y, view.width, view.height);
  const Vec3d pixel_step = frame.camera.ray_direction(x + 1, y, view.width, view.height) - d;
  const Vec3d p = Vec3d(view.position[i].xyz()) - Vec3d(frame.camera.eye);
  const double depth = dot(p, frame.camera.basis().forward);
  const auto corner = [&](int c) { return Vec3d(frame.geometry.corner(view.triangle[i], c)); };
  const Vec3d n = normalize(cross(corner(1) - corner(0), corner(2) - corner(0)));
  return {length(p - d * depth) / (length(pixel_step) * depth),
          std::abs(dot(n, Vec3d(view.position[i].xyz()) - corner(0)))};
}

// Against the double-precision oracle: the same triangle but where a pixel's centre lies within the
// rasteriser's 1/256 pixel of an edge; P on its triangle's plane to float rounding and on its ray to 1/128
// pixel (clamping to the triangle may move it by the rasteriser's snapping); and a normal that faces the
// viewer.
TEST_F(ViewSamplesTest, AgreeWithRaysInDoublePrecisionAtOddSizes) {
  for (const Vec2i size : {Vec2i{1, 1}, Vec2i{37, 53}, Vec2i{320, 200}}) {
    ViewSamples view(device, size.x, size.y);
    view.render(frame, geometry, passes);
    const ViewSamplesHost& got = view.host();
    const testing::HostView want = testing::see(frame.geometry, frame.camera, size.x, size.y);
    std::size_t other_triangle = 0;
    for (std::size_t i = 0; i < got.pixel_count(); ++i) {
      if (got.triangle[i] != want.triangle[i]) {
        ++other_triangle;
        continue;
      }
      if (got.triangle[i] == no_triangle) {
        EXPECT_EQ(got.position[i], Vec4f{});
        continue;
      }
      const Deviation off = deviation(frame, got, i);
      EXPECT_LT(off.pixels, 1.0 / 128) << "pixel " << i;
      EXPECT_LT(off.plane, 1e-6) << "pixel " << i;
      EXPECT_GT(dot(got.geometric_normal[i].xyz(), frame.camera.eye - got.position[i].xyz()), 0.0f);
      EXPECT_NEAR(length(got.geometric_normal[i].xyz()), 1, 1e-5);
      EXPECT_GE(dot(got.shading_normal[i].xyz(), got.geometric_normal[i].xyz()), 0.0f);
      const Vec3f offset = got.origin[i].xyz() - got.position[i].xyz();
      EXPECT_NEAR(length(offset), relative_offset * frame.geometry.bounds.diagonal(), 4e-6);
      EXPECT_EQ(got.origin[i].w, 1.0f);
    }
    EXPECT_LE(double(other_triangle), 0.004 * double(got.pixel_count())) << size.x << " x " << size.y;
  }
}

TEST_F(ViewSamplesTest, AreTheSameBitsInEveryRun) {
  ViewSamples a(device, 129, 65), b(device, 129, 65);
  a.render(frame, geometry, passes);
  b.render(frame, geometry, passes);
  for (std::size_t i = 0; i < a.host().pixel_count(); ++i) ASSERT_EQ(a.host().origin[i], b.host().origin[i]);
}

TEST_F(ViewSamplesTest, FollowAMovedVertex) {
  ViewSamples view(device, 64, 64);
  view.render(frame, geometry, passes);
  const std::vector<Vec4f> before(view.host().position.begin(), view.host().position.end());
  for (Vec3f& p : frame.geometry.positions) p.y += 0.25f;
  frame.changes = {.topology = false, .positions = true, .light = false, .camera = false};
  geometry.update(device, frame, passes);
  view.render(frame, geometry, passes);
  EXPECT_NE(before, std::vector<Vec4f>(view.host().position.begin(), view.host().position.end()));
}

TEST_F(ViewSamplesTest, ReachTheLargestPictureThatIsPromised) {
  ViewSamples view(device, 4096, 4096);
  view.render(frame, geometry, passes);
  const ViewSamplesHost& host = view.host();
  std::size_t seen = 0;
  for (std::size_t i = 0; i < host.pixel_count(); ++i) seen += host.triangle[i] != no_triangle;
  EXPECT_GT(seen, host.pixel_count() / 4);
  EXPECT_NE(host.origin[4096UL * 4000 + 2000].w, 0.0f);  // far past 128 MiB of each array
}

TEST_F(ViewSamplesTest, RefuseAPictureThatTheDeviceCannotHold) {
  EXPECT_THROW(ViewSamples(device, 0, 5), PointError);
  EXPECT_THROW(ViewSamples(device, 1 << 20, 5), PointError);
}

}  // namespace
}  // namespace penumbra
