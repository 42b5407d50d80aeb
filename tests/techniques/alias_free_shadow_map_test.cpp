// alias_free_shadow_map against Embree's hard shadow at the same origin, and against itself: the lists'
// resolution and window must not change a bit.
#include "techniques/alias_free_shadow_map/alias_free_shadow_map.h"

#include <cstdlib>

#include "tests/support/hard_shadow.h"
#include "tests/support/host_view.h"

namespace penumbra::testing {
namespace {

// alias_free_shadow_map on one frame.
class AliasFreeStage : public Stage {
 public:
  using Stage::Stage;
  std::unique_ptr<Technique> make(const ParamValues& given) {
    return built(alias_free_shadow_map_technique(), given);
  }
  using Stage::render;
  Rendered render(const ParamValues& given = {}) { return render(*make(given)); }
  // At the origin that `origin: auto` declares.
  void expect_exact(const Rendered& r) {
    expect_exact(r, frame.geometry.closed ? ReferenceOrigin::exact : ReferenceOrigin::offset);
  }
  void expect_exact(const Rendered& r, ReferenceOrigin origin, double share = 1e-4) {
    auto& truth = truth_[origin == ReferenceOrigin::exact];
    if (!truth) truth = std::make_unique<HardShadow>(*this, origin);
    truth->expect_exact(r, share);
  }

 private:
  std::unique_ptr<HardShadow> truth_[2];
};

// An open ground, a closed box and a soup of open triangles.
Frame mixed_frame(const Light& light) {
  Frame f;
  add_ground(f.geometry, 3);
  add_box(f.geometry, {-1.4f, 0.2f, -0.6f}, {-0.5f, 1.1f, 0.5f});
  add_soup(f.geometry, {0.1f, 0.1f, -0.7f}, {1.5f, 1.2f, 0.7f}, 300, 0.25f, 5);
  Geometry& g = f.geometry;
  g.triangle_instance.assign(g.triangle_count(), 0);
  for (std::size_t t = 2; t < 14; ++t) g.triangle_instance[t] = 1;
  g.instance_closed = {0, 1};
  g.instance_albedo.assign(2, {0.7f, 0.7f, 0.7f});
  f.light = light;
  f.camera.eye = {0.4f, 2.6f, 4.2f}, f.camera.target = {0, 0.3f, 0};
  return f;
}

Light lamp(Vec3f at) {
  Light l;
  l.kind = LightKind::point, l.center = at;
  return l;
}
Light sun(Vec3f direction) {
  Light l;
  l.kind = LightKind::directional, l.direction = normalize(direction);
  return l;
}

struct Place {
  const char *scene, *light;
};
class AliasFreeScene : public ::testing::TestWithParam<Place> {};

TEST_P(AliasFreeScene, DiffersFromEmbreeInTiesAlone) {
  AliasFreeStage stage(scene_frame(GetParam().scene, GetParam().light), 1024, 1024);
  stage.expect_exact(stage.render());
  stage.expect_exact(stage.render({{"origin", "exact"}, {"casters", "both"}}), ReferenceOrigin::exact);
  // Not the declared origin where a mesh is open: a few more may differ, each of them explained all the same.
  stage.expect_exact(stage.render({{"origin", "exact"}}), ReferenceOrigin::exact, 1.1e-4);
}

INSTANTIATE_TEST_SUITE_P(
    At1024, AliasFreeScene,
    ::testing::Values(Place{"bunny", "lamp"}, Place{"bunny", "sun"}, Place{"torus_knot", "lamp"},
                      Place{"torus_knot", "sun"}, Place{"columns", "lamp"}, Place{"bird_nest", "lamp"},
                      Place{"bird_nest", "sun"}, Place{"dragon", "lamp"}, Place{"dragon", "sun"}),
    [](const auto& place) { return std::string(place.param.scene) + "_" + place.param.light; });

TEST(AliasFreeShadowMap, EqualsEmbreeForEveryKindOfLight) {
  for (const char* light : {"spot", "key", "ball", "sun"}) {
    SCOPED_TRACE(light);
    AliasFreeStage stage(scene_frame("torus_knot", light), 384, 256);
    stage.expect_exact(stage.render());
  }
}

TEST(AliasFreeShadowMap, EqualsEmbreeOnOpenAndClosedMeshesAtEachOrigin) {
  for (const Light& light :
       {lamp({1.2f, 4, 1.5f}), lamp({-3, 3, 0.5f}), sun({-0.4f, -1, -0.3f}), sun({0, -1, 0})}) {
    AliasFreeStage stage(mixed_frame(light), 320, 240);
    for (const char* casters : {"back", "both"}) {
      stage.expect_exact(stage.render({{"casters", casters}}));
      stage.expect_exact(stage.render({{"casters", casters}, {"origin", "exact"}}), ReferenceOrigin::exact);
      stage.expect_exact(stage.render({{"casters", casters}, {"origin", "offset"}}), ReferenceOrigin::offset);
    }
  }
}

// grid_size 1 tests every view sample against every triangle: no triangle may miss a list that it touches.
TEST(AliasFreeShadowMap, ListsChangeNoBit) {
  for (const Light& light : {lamp({1.2f, 4, 1.5f}), lamp({0.05f, 0.7f, 1.1f}), sun({-0.4f, -1, -0.3f})}) {
    AliasFreeStage stage(mixed_frame(light), 112, 84);
    const std::vector<float> all = stage.render({{"grid_size", int64_t{1}}}).visibility;
    for (const int64_t grid : {2, 33, 1500})
      for (const bool fit : {true, false})
        EXPECT_EQ(stage.render({{"grid_size", grid}, {"fit", fit}}).visibility, all)
            << grid << (fit ? " fit" : "");
  }
}

// More than 65,535 view samples, which some drivers' loops silently end at, in each row of lists, and in one
// list.
TEST(AliasFreeShadowMap, ListsOfAMillionViewSamplesAreTestedWhole) {
  Frame f;
  add_ground(f.geometry, 3);
  add_box(f.geometry, {-1, 0.2f, -0.6f}, {1, 1.1f, 0.5f});
  f.light = lamp({1.2f, 4, 1.5f});
  f.camera.eye = {0, 4, 0.1f}, f.camera.target = {0, 0, 0};
  f.camera.vertical_fov_degrees = 60;
  AliasFreeStage stage(std::move(f), 1400, 1400);
  const Rendered fine = stage.render();
  for (const int64_t grid : {1, 20}) {
    const Rendered coarse = stage.render({{"grid_size", grid}});
    EXPECT_EQ(coarse.visibility, fine.visibility);
    EXPECT_GT(number(coarse.counters, "list_length_max"), 1e6 / double(grid * grid));
  }
  stage.expect_exact(fine);
}

TEST(AliasFreeShadowMap, LightAmongTheViewSamplesTakesSixFaces) {
  AliasFreeStage stage(mixed_frame(lamp({-0.2f, 0.5f, 0.3f})), 320, 240);
  const Rendered r = stage.render();
  EXPECT_EQ(number(r.counters, "faces"), 6);
  stage.expect_exact(r);
  EXPECT_EQ(number(AliasFreeStage(mixed_frame(lamp({0, 9, 0})), 32, 24).render().counters, "faces"), 1);
}

// Inside a closed mesh, light comes in through triangles that face it: found out by the view samples on its
// inside.
TEST(AliasFreeShadowMap, CameraInsideAClosedMeshIsRight) {
  for (const Light& light : {lamp({0.3f, 5, 0.2f}), lamp({0.3f, 1.5f, 0.2f}), sun({0.2f, -1, 0.1f})}) {
    Frame f;
    add_box(f.geometry, {-2, -2, -2}, {2, 2, 2});
    add_box(f.geometry, {-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f});
    f.geometry.triangle_instance.assign(24, 0);
    f.geometry.instance_closed = {1}, f.geometry.closed = true;
    f.light = light;
    f.camera.eye = {1.5f, 1.2f, 1.7f}, f.camera.target = {0, 0, 0};
    AliasFreeStage stage(std::move(f), 160, 120);
    stage.expect_exact(stage.render());
    stage.expect_exact(stage.render({{"casters", "both"}}));
  }
}

TEST(AliasFreeShadowMap, CountsAreThoseOfTheLists) {
  AliasFreeStage stage(mixed_frame(lamp({1.2f, 4, 1.5f})), 160, 120);
  double facing = 0;
  const ViewSamplesHost& view = stage.view.host();
  for (std::size_t i = 0; i < stage.pixels(); ++i)
    facing += view.triangle[i] != no_triangle &&
              dot(view.geometric_normal[i].xyz(), stage.frame.light.center - view.position[i].xyz()) > 0;
  for (const int64_t grid : {1, 64}) {
    const Counters c = stage.render({{"grid_size", grid}}).counters;
    EXPECT_EQ(number(c, "view_samples_listed"), facing);
    EXPECT_NEAR(number(c, "list_length_mean") * number(c, "lists_occupied"), facing, 1e-6 * facing);
    EXPECT_DOUBLE_EQ(number(c, "occupancy") * double(grid * grid), number(c, "lists_occupied"));
    EXPECT_GE(number(c, "list_length_max"), number(c, "list_length_mean"));
    // Coordinates, place and result of each pixel; length and offset of each list.
    EXPECT_NEAR(number(c, "list_bytes"), double(stage.pixels()) * 24 + double(grid * grid + 1) * 8, 64);
    EXPECT_GT(number(c, "pairs_tested"), facing);
  }
}

TEST(AliasFreeShadowMap, SecondFrameAllocatesNothingAndIsTheSame) {
  AliasFreeStage stage(mixed_frame(lamp({1.2f, 4, 1.5f})), 160, 120);
  const std::unique_ptr<Technique> technique = stage.make({});
  const Rendered first = stage.render(*technique);
  const uint64_t bytes = device().allocated_bytes();
  const Rendered second = stage.render(*technique);
  EXPECT_EQ(device().allocated_bytes(), bytes);
  EXPECT_EQ(first.visibility, second.visibility);
  EXPECT_GE(technique->structure_bytes(), uint64_t(number(first.counters, "list_bytes")));
}

TEST(AliasFreeShadowMap, SkyAloneAndSurfacesThatFaceAwayRender) {
  Frame sky = mixed_frame(lamp({1.2f, 4, 1.5f}));
  sky.camera.eye = {0, 10, 0}, sky.camera.target = {0, 20, 0.1f};
  AliasFreeStage above(std::move(sky), 64, 48);
  EXPECT_EQ(number(above.render().counters, "view_samples_listed"), 0);
  AliasFreeStage below(mixed_frame(lamp({0, -3, 0})), 64, 48);
  for (const float v : below.render({{"casters", "both"}}).visibility) EXPECT_TRUE(v == 0 || v == 1);
}

}  // namespace
}  // namespace penumbra::testing
