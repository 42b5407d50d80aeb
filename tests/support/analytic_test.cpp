#include "tests/support/analytic.h"

#include <gtest/gtest.h>

namespace penumbra::testing {
namespace {

// 2 x 2 in the plane z = 4, shining down to z = 0.
Light overhead() {
  Light light;
  light.kind = LightKind::rectangle;
  light.center = {0, 0, 4};
  light.direction = {0, 0, -1};
  light.edge_u = {0, 2, 0}, light.edge_v = {2, 0, 0};
  return light;
}

Polygon square(double z, double x0, double x1, double y0, double y1) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

constexpr Vec3d up{0, 0, 1};

TEST(RectangleVisibility, IsOneWithNothingBetween) {
  EXPECT_DOUBLE_EQ(rectangle_visibility(overhead(), {0.3, 0.2, 0}, up, {}), 1);
}

TEST(RectangleVisibility, ScalesAnOccluderHalfWayByTwo) {
  // From the origin the square at half height of side 0.5 hides a square of side 1 of the light's 2 x 2.
  const std::vector<Polygon> occluder{square(2, -0.25, 0.25, -0.25, 0.25)};
  EXPECT_NEAR(rectangle_visibility(overhead(), {0, 0, 0}, up, occluder), 0.75, 1e-15);
  // Moved by 0.25, its corner is at the light's middle: it hides one quarter of the light's quarter.
  const std::vector<Polygon> half{square(2, 0, 10, -10, 10)};
  EXPECT_NEAR(rectangle_visibility(overhead(), {0, 0, 0}, up, half), 0.5, 1e-15);
}

TEST(RectangleVisibility, LeavesOutWhatIsBehindTheLightOrTheReceiver) {
  const std::vector<Polygon> beyond{square(5, -10, 10, -10, 10)}, below{square(-1, -10, 10, -10, 10)};
  EXPECT_DOUBLE_EQ(rectangle_visibility(overhead(), {0, 0, 0}, up, beyond), 1);
  EXPECT_DOUBLE_EQ(rectangle_visibility(overhead(), {0, 0, 0}, up, below), 1);
}

TEST(RectangleVisibility, IsCutByTheHorizonAndTheLightsBack) {
  EXPECT_NEAR(rectangle_visibility(overhead(), {0, 0, 0}, {1, 0, 0}, {}), 0.5, 1e-15);
  EXPECT_NEAR(rectangle_visibility(overhead(), {-0.5, 0, 0}, {1, 0, 0}, {}), 0.75, 1e-15);
  EXPECT_EQ(rectangle_visibility(overhead(), {0, 0, 5}, {0, 0, -1}, {}), 0);
}

TEST(FacesTowards, AreThoseThatTheViewerSees) {
  EXPECT_EQ(faces_towards({0, 0, -3}, {-1, -1, -1}, {1, 1, 1}).size(), 1U);
  EXPECT_EQ(faces_towards({3, 0, -3}, {-1, -1, -1}, {1, 1, 1}).size(), 2U);
  EXPECT_EQ(faces_towards({3, 3, -3}, {-1, -1, -1}, {1, 1, 1}).size(), 3U);
}

TEST(FacesTowards, CoverABoxOnce) {
  // The box's silhouette from the origin is its lower face (z = 1, side 1), projected to side 4: it hides
  // all.
  const auto centred = faces_towards({0, 0, 0}, {-0.5, -0.5, 1}, {0.5, 0.5, 2});
  EXPECT_NEAR(rectangle_visibility(overhead(), {0, 0, 0}, up, centred), 0, 1e-15);
  // Beside the axis: the near edge of the upper face (x = 0.25 at z = 2) bounds the shadow at x = 0.5.
  const auto beside = faces_towards({0, 0, 0}, {0.25, -5, 1}, {5, 5, 2});
  EXPECT_NEAR(rectangle_visibility(overhead(), {0, 0, 0}, up, beside), 0.75, 1e-15);
}

}  // namespace
}  // namespace penumbra::testing
