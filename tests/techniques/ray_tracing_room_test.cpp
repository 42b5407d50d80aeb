// ray_tracing behind the technique contract, against the matched reference.
#include <gtest/gtest.h>

#include "reference/reference.h"
#include "techniques/ray_tracing/ray_tracing.h"
#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"

namespace penumbra {
namespace {

using testing::BruteForce;
using testing::Differences;

struct Setting {
  gpu::Device device;
  gpu::PassRecorder passes{device};
  Frame frame;
  GeometryOnDevice geometry;
  ViewSamples views{device, 61, 43};
  LightSamples samples;
  std::vector<float> visibility;
  std::vector<uint32_t> mask;

  Setting() {
    testing::add_ground(frame.geometry, 2);
    testing::add_soup(frame.geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, 150, 0.15F, 11);
    frame.camera.eye = {0, 1.5F, 3.5F}, frame.camera.target = {0, 0.6F, 0};
    use_light(testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F));
    see();
  }
  void use_light(const Light& light) {
    frame.light = light;
    samples = make_light_samples(light, {8, 8});
  }
  void see() {
    geometry.update(device, frame, passes);
    views.render(frame, geometry, passes);
    passes.take_times();
  }
  Case scene_case() { return {&device, &frame, &geometry, &samples, views.width(), views.height()}; }
  void move() {
    for (std::size_t v = 6; v < frame.geometry.positions.size(); ++v) frame.geometry.positions[v].x += 0.07F;
    ++frame.index;
    frame.changes = {false, true, false, false};
    see();
  }

  std::vector<std::string> build(Technique& technique) {
    const Case c = scene_case();
    technique.build(c, passes);
    return pass_names();
  }
  std::vector<std::string> render(Technique& technique) {
    const std::size_t pixels = views.host().pixel_count();
    visibility.assign(pixels, -7.0F);
    mask.assign(pixels * static_cast<std::size_t>(samples.mask_words()), 0xdeadbeefU);
    const Case c = scene_case();
    RenderInput in;
    in.scene_case = &c, in.view_samples = &views, in.host = {visibility, mask};
    technique.render(in, passes);
    return pass_names();
  }
  std::vector<std::string> pass_names() {
    std::vector<std::string> names;
    for (const gpu::PassTime& t : passes.take_times()) names.push_back(t.name);
    return names;
  }

  void expect_the_reference() {
    const MatchedReference m =
        ReferenceScene(frame.geometry).matched(views.host(), frame.light, samples, ReferenceOrigin::offset);
    const Differences d = testing::explain_differences(BruteForce(frame.geometry), frame.light, samples,
                                                       views.host(), mask, m.mask, m.evaluated);
    EXPECT_EQ(d.unexplained, 0U);
    EXPECT_LE(d.differing, d.bits / 10000);
    std::size_t shadowed = 0;
    for (std::size_t i = 0; i < m.evaluated.size(); ++i) shadowed += m.evaluated[i] && m.visibility[i] < 1;
    EXPECT_GT(shadowed, 50U);
  }
};

std::unique_ptr<Technique> make(const ParamValues& given) {
  const TechniqueInfo info = ray_tracing_technique();
  return info.make(resolve(info.params, given, "test"));
}

TEST(RayTracingRoom, GivesTheReferencesMask) {
  Setting s;
  const auto technique = make({});
  ASSERT_FALSE(technique->supports(s.scene_case()));
  EXPECT_EQ(s.build(*technique),
            (std::vector<std::string>{"copy_geometry", "build_hierarchy", "order_light_samples"}));
  EXPECT_EQ(s.render(*technique), (std::vector<std::string>{"trace"}));
  s.expect_the_reference();
  EXPECT_TRUE(s.device.validation_messages().empty());
}

TEST(RayTracingRoom, TakesEveryKindOfLight) {
  Setting s;
  Light light = s.frame.light;
  light.radius = 0.3F, light.cone_degrees = 20, light.texture_width = 2, light.texture_height = 1;
  light.weights = {0.2F, 0.8F};
  for (const LightKind kind :
       {LightKind::point, LightKind::directional, LightKind::spot, LightKind::sphere}) {
    light.kind = kind;
    s.use_light(light);
    const auto technique = make({});
    s.build(*technique);
    s.render(*technique);
    s.expect_the_reference();
  }
}

TEST(RayTracingRoom, FollowsMovingGeometryAtEveryBuildQuality) {
  for (const char* quality : {"auto", "low", "medium", "high", "refit"}) {
    SCOPED_TRACE(quality);
    Setting s;
    const auto technique = make({{"dynamic", true}, {"build_quality", std::string(quality)}});
    s.build(*technique);
    for (int i = 0; i < 2; ++i) {
      s.move();
      const std::string pass = quality == std::string("refit") ? "refit_hierarchy" : "build_hierarchy";
      EXPECT_EQ(s.build(*technique),
                (std::vector<std::string>{"copy_vertices", pass, "order_light_samples"}));
      s.render(*technique);
      s.expect_the_reference();
    }
  }
}

// The harness builds a dynamic point every frame, also when the frame is the first one again.
TEST(RayTracingRoom, ADynamicPointRebuildsWithoutBeingToldOfAChange) {
  Setting s;
  const auto technique = make({{"dynamic", true}});
  s.build(*technique);
  EXPECT_EQ(s.build(*technique),
            (std::vector<std::string>{"copy_vertices", "build_hierarchy", "order_light_samples"}));
  s.render(*technique);
  s.expect_the_reference();
}

TEST(RayTracingRoom, AChangedLightDoesNotRebuildAStaticScene) {
  Setting s;
  const auto technique = make({});
  s.build(*technique);
  s.use_light(testing::rectangle_light({-1, 2.5F, 1}, {0, 0, 0}, 0.3F, 0.5F));
  s.frame.changes = {false, false, true, false};
  EXPECT_EQ(s.build(*technique), (std::vector<std::string>{"order_light_samples"}));
  s.render(*technique);
  s.expect_the_reference();
}

TEST(RayTracingRoom, CountsRaysAndBytes) {
  Setting s;
  const auto technique = make({});
  s.build(*technique);
  s.render(*technique);
  const Counters c = technique->counters();
  double seen = 0;
  for (const uint32_t t : s.views.host().triangle) seen += t != no_triangle;
  EXPECT_EQ(std::get<double>(c.at("rays")) + std::get<double>(c.at("light_samples_without_ray")), 64 * seen);
  EXPECT_GT(std::get<double>(c.at("bvh_bytes")), 1000);
  EXPECT_GE(technique->structure_bytes(), static_cast<uint64_t>(std::get<double>(c.at("bvh_bytes"))));
}

TEST(RayTracingRoom, GivesTheSameBitsEachTime) {
  Setting s;
  const auto technique = make({});
  s.build(*technique);
  s.render(*technique);
  const std::vector<uint32_t> first = s.mask;
  s.render(*technique);
  EXPECT_EQ(s.mask, first);
}

TEST(RayTracingRoom, RefusesASceneWithoutTriangles) {
  Setting s;
  s.frame.geometry = {};
  EXPECT_TRUE(make({})->supports(s.scene_case()));
}

TEST(RayTracingRoom, AsksForABuildEachFrameWhenDynamic) {
  const TechniqueInfo info = ray_tracing_technique();
  EXPECT_TRUE(info.rebuild_each_frame(resolve(info.params, {{"dynamic", true}}, "test")));
  EXPECT_FALSE(info.rebuild_each_frame(resolve(info.params, {}, "test")));
  EXPECT_EQ(info.origin(resolve(info.params, {}, "test")), Origin::offset);
}

}  // namespace
}  // namespace penumbra
