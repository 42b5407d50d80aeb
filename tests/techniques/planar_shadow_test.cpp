// Projected shadows against Embree on the plane, and what the projection must and must not do.
#include "techniques/planar_shadow/planar_shadow.h"

#include <bit>

#include "stencil_planar_stage.h"
#include "techniques/planar_shadow/receiver.h"

namespace penumbra::test {
namespace {

const TechniqueInfo info = planar_shadow_technique();

// Triangles appended since the last call become an instance of their own.
void as_instance(Geometry& g, std::size_t first_triangle, uint32_t instance) {
  g.triangle_instance.resize(g.triangle_count());
  for (std::size_t t = first_triangle; t < g.triangle_count(); ++t) g.triangle_instance[t] = instance;
  g.instance_albedo.resize(std::max<std::size_t>(g.instance_albedo.size(), instance + 1), {0.5f, 0.5f, 0.5f});
}

Frame box_over_ground(const Light& light) {
  Frame f;
  testing::add_ground(f.geometry, 4);
  as_instance(f.geometry, 0, 0);
  testing::add_box(f.geometry, {-1, 0.5f, -1}, {1, 1.5f, 1});
  as_instance(f.geometry, 2, 1);
  f.light = light;
  f.camera = camera_at({2, 4, 6}, {0, 0, 0});
  return f;
}

TEST(PlanarShadow, DiffersFromTheReferenceOnThePlaneOnlyInTies) {
  std::vector<Light> lights{point_light({1.5f, 5, 1}), directional_light({-0.4f, -1, -0.3f}),
                            testing::rectangle_light({1, 5, 2}, {0, 0, 0}, 1.5f, 1)};
  lights.push_back(testing::spot_light({1, 5, 2}, {0, 0, 0}, 25));
  for (const Light& light : lights) {
    SCOPED_TRACE(to_string(light.kind));
    Stage stage(box_over_ground(light), 161, 119);
    LightSampleRequest request;
    request.width = 7, request.height = 5;  // more than a word, not a whole number of batches
    stage.light_samples = make_light_samples(light, request);
    const Rendered m = stage.render(info, {});
    std::size_t compared = 0;
    const std::size_t off = stage.differing_bits(m, &compared);
    EXPECT_GT(compared, 5000U);
    EXPECT_LT(double(off), 0.002 * double(compared));
    for (std::size_t i = 0; i < stage.pixels(); ++i) {  // visibility is the share of clear bits
      if (!m.evaluated[i]) continue;
      const std::size_t words = stage.mask_words();
      int blocked = 0;
      for (std::size_t w = 0; w < words; ++w) blocked += std::popcount(m.mask[i * words + w]);
      const double n = stage.light_samples.count();
      EXPECT_NEAR(double{m.visibility[i]}, (n - blocked) / n, 1e-6);
    }
  }
}

TEST(PlanarShadow, DiffersOnlyInTiesUnderAMesh) {
  Stage stage(Scene::load("torus_knot", {"configs/scenes"}).frame(0, "key", "front", -1), 128, 128);
  stage.light_samples = make_light_samples(stage.frame.light, {3, 3});
  const Rendered m = stage.render(info, {});
  std::size_t compared = 0;
  const std::size_t off = stage.differing_bits(m, &compared);
  std::printf("[measured] torus knot: %zu of %zu bits differ\n", off, compared);
  EXPECT_LT(double(off), 1e-3 * double(compared));
}

// Part of the ground is behind the first rectangle, part of the second rectangle is below the ground; the
// camera then looks from below.
TEST(PlanarShadow, KnowsWhatIsBehindTheLightOrBelowTheHorizon) {
  for (const Light& light : {testing::rectangle_light({1, 2, 2}, {3, 1.5f, 3}, 1.5f, 1),
                             testing::rectangle_light({3, 0.3f, 2}, {0, 0.2f, 0}, 1.5f, 2)})
    for (const float eye_height : {4.0f, -4.0f}) {
      Frame f = box_over_ground(light);
      f.camera = camera_at({2, eye_height, 6}, {0, 0, 0});
      Stage stage(std::move(f), 129, 97);
      stage.light_samples = make_light_samples(light, {6, 6});
      const Rendered m = stage.render(info, {});
      std::size_t compared = 0;
      const std::size_t off = stage.differing_bits(m, &compared);
      if (eye_height < 0 && light.center.y > 1) {
        EXPECT_EQ(compared, 0U) << "nothing is above the horizon";
        continue;
      }
      EXPECT_GT(compared, 5000U);
      EXPECT_LT(double(off), 0.002 * double(compared));
    }
}

TEST(Receiver, TellsWhichLightSamplesAreBelowItsHorizon) {
  Geometry g;
  testing::add_ground(g, 4);
  as_instance(g, 0, 0);
  const auto receiver = std::get<planar_shadow::Receiver>(planar_shadow::find_receiver(g, -1));
  LightSamples samples;
  samples.points = {{0, 1, 0, 1}, {0, -1, 0, 1}, {0.6f, 0.8f, 0, 0}, {0.6f, -0.8f, 0, 0}};
  samples.weights.assign(4, 0.25f);
  const Vec4f everywhere{0, -1, 0, -1}, cone{0, -1, 0, 0.7f};
  std::vector<uint32_t> dark;
  EXPECT_TRUE(planar_shadow::same_horizon(receiver, samples, everywhere, {0, 3, 0}, dark));
  EXPECT_EQ(dark, std::vector<uint32_t>{0b1010});
  EXPECT_TRUE(planar_shadow::same_horizon(receiver, samples, everywhere, {0, -3, 0}, dark));
  EXPECT_EQ(dark, std::vector<uint32_t>{0b0101});
  EXPECT_FALSE(planar_shadow::same_horizon(receiver, samples, everywhere, {0, 1e-5, 0}, dark));
  EXPECT_FALSE(planar_shadow::same_horizon(receiver, samples, cone, {0, 3, 0}, dark));
  samples.points[1].y = 1e-5f;  // grazes the ground
  EXPECT_FALSE(planar_shadow::same_horizon(receiver, samples, everywhere, {0, 3, 0}, dark));
}

TEST(PlanarShadow, SecondFrameAllocatesNothingAndGivesTheSameBits) {
  Stage stage(box_over_ground(testing::rectangle_light({1, 5, 2}, {0, 0, 0}, 1.5f, 1)), 100, 60);
  stage.light_samples = make_light_samples(stage.frame.light, {7, 5});
  const std::unique_ptr<Technique> t = stage.built(info, {});
  const Rendered first = stage.render(*t, true);
  const uint64_t held = device().allocated_bytes();
  EXPECT_GT(t->structure_bytes(), 0U);
  stage.render_only(*t, true);
  EXPECT_EQ(device().allocated_bytes(), held);
  const Rendered second = stage.render(*t, true);
  EXPECT_EQ(second.visibility, first.visibility);
  EXPECT_EQ(second.mask, first.mask);
}

TEST(PlanarShadow, NothingFallsOffTheReceiver) {
  Stage stage(box_over_ground(point_light({1.5f, 5, 1})), 128, 96);
  const Rendered m = stage.render(info, {});
  const ViewSamplesHost& view = stage.view.host();
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    const bool ground = view.triangle[i] != no_triangle && view.triangle[i] < 2;
    EXPECT_EQ(m.evaluated[i] != 0, ground) << i;
    if (!ground) {
      EXPECT_EQ(m.visibility[i], 1.0f) << i;
    }
  }
}

TEST(PlanarShadow, OverlappingOccludersDarkenOnce) {
  Frame once = box_over_ground(point_light({1.5f, 5, 1})), thrice = once;
  for (float y : {1.0f, 1.3f}) testing::add_box(thrice.geometry, {-0.5f, y, -0.5f}, {0.5f, y + 0.1f, 0.5f});
  as_instance(thrice.geometry, 14, 1);
  Stage a(std::move(once), 128, 96), b(std::move(thrice), 128, 96);
  EXPECT_EQ(a.render(info, {}).visibility, b.render(info, {}).visibility);
}

// What is beyond the light, or behind the plane, has an image in the projection but casts no shadow.
TEST(PlanarShadow, OccludersBeyondTheLightOrBehindThePlaneCastNothing) {
  Frame f;
  testing::add_ground(f.geometry, 4);
  as_instance(f.geometry, 0, 0);
  testing::add_box(f.geometry, {-1, 4, -1}, {1, 5, 1});
  testing::add_box(f.geometry, {-1, -2, -1}, {1, -1, 1});
  as_instance(f.geometry, 2, 1);
  f.light = point_light({0.2f, 3, 0.1f}), f.camera = camera_at({2, 2.5f, 6}, {0, 0, 0});
  Stage stage(std::move(f), 128, 96);
  const Rendered m = stage.render(info, {});
  for (std::size_t i = 0; i < stage.pixels(); ++i)
    if (m.evaluated[i]) {
      EXPECT_EQ(m.visibility[i], 1.0f) << i;
    }
}

TEST(PlanarShadow, SaysWhyAReceiverIsNone) {
  Stage stage(box_over_ground(point_light({1.5f, 5, 1})), 16, 16);
  const auto reason = [&](int64_t receiver) {
    return Stage::make(info, {{"receiver", receiver}})->supports(stage.the_case).value_or("");
  };
  EXPECT_EQ(reason(-1), "");
  EXPECT_EQ(reason(0), "");
  EXPECT_NE(reason(1).find("not flat"), std::string::npos);
  EXPECT_NE(reason(2).find("2 instances"), std::string::npos);
  Frame boxes;
  testing::add_box(boxes.geometry, {-1, 0, -1}, {1, 1, 1});
  boxes.light = point_light({0, 4, 0});
  Stage none(std::move(boxes), 16, 16);
  EXPECT_NE(Stage::make(info, {})->supports(none.the_case).value_or("").find("No instance"),
            std::string::npos);
}

TEST(Receiver, IsTheFlatInstanceOfLargestArea) {
  Geometry g;
  testing::add_box(g, {-9, 0, -9}, {9, 9, 9});  // larger, not flat
  as_instance(g, 0, 0);
  testing::add_triangle(g, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  as_instance(g, 12, 1);
  testing::add_triangle(g, {0, 2, 0}, {3, 2, 0}, {0, 2, 3});
  as_instance(g, 13, 2);
  const auto found = planar_shadow::find_receiver(g, -1);
  ASSERT_TRUE(std::holds_alternative<planar_shadow::Receiver>(found));
  const auto& r = std::get<planar_shadow::Receiver>(found);
  EXPECT_EQ(r.instance, 2U);
  EXPECT_DOUBLE_EQ(r.area, 4.5);
  EXPECT_DOUBLE_EQ(r.plane.w, 2 * -r.plane.y);
  EXPECT_EQ(planar_shadow::occluder_indices(g, 2).size(), 39U);
}

// [Blinn 1988]: the image of a point lies in the plane and on the ray from the light through the point.
TEST(OntoPlane, MovesPointsAlongTheirRayIntoThePlane) {
  const Vec4d plane{0.6, 0.8, 0, -1};
  for (const Vec4d light : {Vec4d{3, 6, -2, 1}, Vec4d{-5, -4, 1, 1}, Vec4d{0, 1, 0, 0}}) {
    const Mat4d m = planar_shadow::onto_plane(plane, light);
    const Vec3d q{0.5, 2.1, 0.7};
    const Vec4d image = m * Vec4d{q.x, q.y, q.z, 1};
    const Vec3d x = image.xyz() / image.w;
    EXPECT_NEAR(dot(plane.xyz(), x) + plane.w, 0, 1e-12);
    const Vec3d along = light.xyz() - q * light.w;
    EXPECT_NEAR(length(cross(x - q, along)), 0, 1e-12 * length(along) * length(x - q) + 1e-12);
  }
}

}  // namespace
}  // namespace penumbra::test
