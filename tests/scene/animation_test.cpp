#include "scene/animation.h"

#include "fixtures.h"

namespace penumbra::test {
namespace {

const std::string meshes = R"("box": {"generator": "box"}, "ball": {"generator": "sphere"})";
const std::string instances =
    R"({"mesh": "box"}, {"mesh": "ball", "transform": [{"scale": 0.25}, {"translate": [3, 0, 0]}]})";

class AnimationTest : public ::testing::Test {
 protected:
  Scene animated(const std::string& animation) const {
    return load_text(folder_, scene_text(meshes, instances, animation));
  }
  TemporaryFolder folder_;
};

void expect_changes(const Changes& c, bool topology, bool positions, bool light, bool camera) {
  EXPECT_EQ(c.topology, topology);
  EXPECT_EQ(c.positions, positions);
  EXPECT_EQ(c.light, light);
  EXPECT_EQ(c.camera, camera);
}

TEST(Timeline, HoldsItsEndsAndRunsStraightBetween) {
  const Timeline t{{10, 20, 40}, false};
  EXPECT_EQ(t.at(0).from, 0U);
  EXPECT_EQ(t.at(0).t, 0);
  EXPECT_EQ(t.at(15).from, 0U);
  EXPECT_DOUBLE_EQ(t.at(15).t, 0.5);
  EXPECT_EQ(t.at(20).from, 1U);
  EXPECT_DOUBLE_EQ(t.at(35).t, 0.75);
  EXPECT_EQ(t.at(99).from, 2U);
}

TEST(Timeline, LoopsFromLastToFirst) {
  const Timeline t{{0, 10}, true};
  EXPECT_DOUBLE_EQ(t.at(13).t, 0.3);
  EXPECT_DOUBLE_EQ(t.at(10).t, 0);
  EXPECT_EQ(t.at(10).from, 0U);
}

TEST_F(AnimationTest, FirstFrameIsAllNewAndAStillOneIsNot) {
  const Scene s = animated("");
  const Frame first = s.frame(0, "", "", -1);
  expect_changes(first.changes, true, true, true, true);
  const Frame second = s.frame(1, "", "", -1, &first);
  EXPECT_FALSE(second.changes.any());
  EXPECT_FALSE(s.animated());
}

TEST_F(AnimationTest, OtherLightCameraOrSizeIsAChange) {
  const Scene s = animated("");
  const Frame first = s.frame(0, "", "", -1);
  expect_changes(s.frame(0, "lamp", "", -1, &first).changes, false, false, true, false);
  expect_changes(s.frame(0, "", "", 3, &first).changes, false, false, true, false);
  EXPECT_FLOAT_EQ(s.frame(0, "", "", 3, &first).light.size(), 3);
  EXPECT_EQ(s.frame(0, "", "", 0, &first).light.kind, LightKind::point);
}

TEST_F(AnimationTest, CameraPathMovesOnlyTheCamera) {
  const Scene s = animated(R"({"cameras": [{"camera": "front", "keyframes": [
      {"frame": 0, "eye": [0, 1, 5]}, {"frame": 10, "eye": [10, 1, 5], "target": [2, 0, 0]}]}]})");
  EXPECT_TRUE(s.animated());
  const Frame a = s.frame(0, "", "", -1), b = s.frame(5, "", "", -1, &a), c = s.frame(10, "", "", -1, &b);
  EXPECT_EQ(b.camera.eye, (Vec3f{5, 1, 5}));
  EXPECT_EQ(b.camera.target, (Vec3f{1, 0, 0}));
  EXPECT_EQ(c.camera.eye, (Vec3f{10, 1, 5}));
  expect_changes(b.changes, false, false, false, true);
  EXPECT_FALSE(s.frame(11, "", "", -1, &c).changes.any());  // the end holds
}

TEST_F(AnimationTest, MovingLightChangesOnlyTheLight) {
  const Scene s = animated(R"({"lights": [{"light": "key", "loop": true, "keyframes": [
      {"frame": 0, "center": [0, 5, 0]}, {"frame": 10, "center": [4, 5, 0]}]}]})");
  const Frame a = s.frame(0, "", "", -1), b = s.frame(5, "", "", -1, &a);
  EXPECT_EQ(b.light.center, (Vec3f{2, 5, 0}));
  EXPECT_EQ(b.light.edge_u, a.light.edge_u);
  expect_changes(b.changes, false, false, true, false);
  const Frame lamp = s.frame(0, "lamp", "", -1);
  EXPECT_FALSE(s.frame(5, "lamp", "", -1, &lamp).changes.any());  // another light, which stands still
}

TEST_F(AnimationTest, RigidMotionMovesOneInstanceAndKeepsItsShape) {
  const Scene s = animated(R"({"instances": [{"instance": "ball", "axis": [0, 1, 0], "keyframes": [
      {"frame": 0, "degrees": 0}, {"frame": 4, "degrees": 360}]}]})");
  const Frame a = s.frame(0, "", "", -1), b = s.frame(1, "", "", -1, &a);
  expect_changes(b.changes, false, true, false, false);
  for (std::size_t v = 0; v < 24; ++v)
    EXPECT_EQ(a.geometry.positions[v], b.geometry.positions[v]);  // the box
  for (std::size_t v = 24; v < b.geometry.positions.size(); ++v) {
    const Vec3f p = a.geometry.positions[v], q = b.geometry.positions[v], n = a.geometry.normals[v];
    EXPECT_NEAR(length(q - Vec3f{p.z, p.y, -p.x}), 0, 1e-5);  // a quarter turn about y
    EXPECT_NEAR(length(b.geometry.normals[v] - Vec3f{n.z, n.y, -n.x}), 0, 1e-5);
  }
  EXPECT_NEAR(b.geometry.bounds.lo.z, -3.25f, 1e-4f);
  EXPECT_EQ(s.frame(0, "", "", -1).geometry.positions, a.geometry.positions);
}

TEST_F(AnimationTest, PivotStaysInPlaceUnderScaleAndTurn) {
  const Scene s =
      animated(R"({"instances": [{"instance": "ball", "pivot": [3, 0, 0], "axis": [0, 0, 1], "keyframes": [
      {"frame": 0}, {"frame": 1, "degrees": 77, "scale": 2, "translate": [0, 1, 0]}]}]})");
  const Frame f = s.frame(1, "", "", -1);
  for (std::size_t v = 24; v < f.geometry.positions.size(); ++v)
    EXPECT_NEAR(length(f.geometry.positions[v] - Vec3f{3, 1, 0}), 0.5f, 1e-5f);
}

TEST_F(AnimationTest, TwistTurnsByHeightAndCarriesNormals) {
  const Scene s =
      animated(R"({"deformations": [{"instance": "ball", "kind": "twist", "axis": "y", "amplitude": 90,
      "period": 4}]})");
  const Frame a = s.frame(0, "", "", -1), b = s.frame(1, "", "", -1, &a);  // a quarter period: full amplitude
  expect_changes(b.changes, false, true, false, false);
  EXPECT_EQ(b.geometry.indices, a.geometry.indices);
  for (std::size_t v = 24; v < b.geometry.positions.size(); ++v) {
    const Vec3f p = a.geometry.positions[v] - Vec3f{3, 0, 0}, q = b.geometry.positions[v] - Vec3f{3, 0, 0};
    EXPECT_NEAR(length(p), length(q), 1e-5f);
    EXPECT_FLOAT_EQ(p.y, q.y);
  }
}

TEST(Deformation, NormalsAreThoseOfTheDeformedSurface) {
  Deformation d;
  d.kind = DeformationKind::wave;
  d.axis = 0, d.direction = 1;
  d.amplitude = 0.2, d.wavelength = 2, d.period = 8;
  Box bounds;
  bounds.extend({-1, 0, -1}), bounds.extend({1, 0, 1});
  for (const double x : {-0.7, 0.0, 0.4}) {
    const Vec3d n = d.apply_to_normal({x, 0, 0.3}, {0, 1, 0}, bounds, 3);
    const double slope = 0.2 * std::acos(-1.0) * std::cos(2 * std::acos(-1.0) * (x / 2 - 3 / 8.0));
    const Vec3d expected = normalize(Vec3d{-slope, 1, 0});
    EXPECT_NEAR(length(n - expected), 0, 1e-6);
  }
}

TEST(Deformation, BendKeepsItsFoot) {
  Deformation d;
  d.kind = DeformationKind::bend;
  d.amplitude = 40, d.period = 4;
  Box bounds;
  bounds.extend({-1, 0, -1}), bounds.extend({1, 2, 1});
  const Vec3d foot = d.apply({0.5, 0, 0.25}, bounds, 1);
  EXPECT_NEAR(length(foot - Vec3d{0.5, 0, 0.25}), 0, 1e-12);
  const Vec3d top = d.apply({0, 2, 0}, bounds, 1);
  EXPECT_NEAR(top.x, 2 * std::sin(40 * std::acos(-1.0) / 180), 1e-9);  // towards +x, the direction
}

TEST_F(AnimationTest, MistakesInTracksAreNamed) {
  const auto error = [&](const std::string& text) { return input_error_of([&] { animated(text); }); };
  EXPECT_CONTAINS(error(R"({"cameras": [{"camera": "frnt", "keyframes": [{"frame": 0}]}]})"),
                  "Did you mean 'front'?");
  EXPECT_CONTAINS(error(R"({"cameras": [{"camera": "front", "keyframes": [{"frame": 3}, {"frame": 3}]}]})"),
                  "/animation/cameras/0/keyframes/1/frame");
  EXPECT_CONTAINS(error(R"({"cameras": [{"camera": "front", "keyframes": []}]})"), "at least one keyframe");
  EXPECT_CONTAINS(error(R"({"instances": [{"instance": "box", "keyframes": [{"frame": 0}]},
      {"instance": "box", "keyframes": [{"frame": 0}]}]})"),
                  "has a track already");
  EXPECT_CONTAINS(
      error(R"({"deformations": [{"instance": "box", "kind": "twst", "amplitude": 1, "period": 2}]})"),
      "Did you mean 'twist'?");
  EXPECT_CONTAINS(
      error(R"({"lights": [{"light": "key", "keyframes": [{"frame": 0, "direction": [0, 1, 0]}]}]})"),
      "direction");
  EXPECT_CONTAINS(input_error_of([&] { animated("").frame(-1, "", "", -1); }), "found frame -1");
}

}  // namespace
}  // namespace penumbra::test
