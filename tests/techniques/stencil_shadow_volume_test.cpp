// Shadow volumes against Embree at the view samples themselves, and against the lecture's test of each point
// against each triangle's volume.
#include <bit>

#include "near_plane_clear.h"
#include "stencil_shadow_volume_frames.h"

namespace penumbra::test {
namespace {

// A quad whose triangles share their diagonal's vertices; counter-clockwise seen from u x v.
void add_shared_quad(Geometry& g, Vec3f corner, Vec3f u, Vec3f v) {
  const auto first = static_cast<uint32_t>(g.positions.size());
  for (Vec3f p : {corner, corner + u, corner + u + v, corner + v})
    g.positions.push_back(p), g.normals.push_back(normalize(cross(u, v))), g.bounds.extend(p);
  for (uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) g.indices.push_back(first + i);
  g.triangle_instance.insert(g.triangle_instance.end(), 2, 0U);
}

// The lecture's pseudo code: is the point behind the triangle, and within the planes through the light and
// its edges?
bool in_volume(Vec3d p, Vec4d light, Vec3d a, Vec3d b, Vec3d c) {
  const auto side = [&](Vec3d u, Vec3d v, Vec3d x) {  // of the plane through u, v and the light
    const Vec3d to_light = light.xyz() - u * light.w;
    return dot(cross(v - u, to_light), x - u);
  };
  const Vec3d n = cross(b - a, c - a);
  const double facing = dot(n, light.xyz() - a * light.w);
  if (facing == 0 || dot(n, p - a) * facing >= 0) return false;
  const double s = facing > 0 ? -1 : 1;
  return s * side(a, b, p) >= 0 && s * side(b, c, p) >= 0 && s * side(c, a, p) >= 0;
}

TEST(StencilShadowVolume, AgreesWithThePointInVolumeTestOfTheLecture) {
  Frame f = box_on_ground(point_light({2, 5, 1}));
  testing::add_soup(f.geometry, {-3, 1, -3}, {3, 3, 3}, 40, 0.7f, 7);
  Stage stage(std::move(f), 97, 61);
  const Rendered r = stage.render(info, params("z_fail"));
  const Geometry& g = stage.frame.geometry;
  int compared = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    if (!stage.truth().evaluated[i] || stage.flips(i, 1.0 / 64)) continue;
    ++compared;
    bool blocked = false;
    for (std::size_t t = 0; t < g.triangle_count(); ++t)
      blocked |= t != stage.view.host().triangle[i] &&
                 in_volume(Vec3d(stage.view.host().position[i].xyz()), stage.towards(), Vec3d(g.corner(t, 0)),
                           Vec3d(g.corner(t, 1)), Vec3d(g.corner(t, 2)));
    EXPECT_EQ(r.visibility[i], blocked ? 0.0f : 1.0f) << i;
  }
  EXPECT_GT(compared, 3000);
}

// Every light on open, closed, non-manifold and inside-out geometry, in every variant that is right with this
// camera.
struct Named {
  const char* name;
  Frame frame;
};
std::vector<Named> awkward_scenes() {
  std::vector<Named> scenes;
  const auto add = [&](const char* name, Frame f) { scenes.push_back({name, std::move(f)}); };
  for (const Light& light : {point_light({1.5f, 5, 1}), directional_light({-0.4f, -1, -0.3f})}) {
    add("box", box_on_ground(light));
    Frame soup = box_on_ground(light);
    testing::add_soup(soup.geometry, {-3, 1, -3}, {3, 3, 3}, 200, 0.6f, 3);
    add("open and intersecting triangles", std::move(soup));
    Frame book;  // three pages and a fourth, the other way round, on one edge
    testing::add_ground(book.geometry, 6);
    for (Vec3f page : {Vec3f{1.5f, 0.2f, 0}, Vec3f{-1.2f, 0.6f, 0.1f}, Vec3f{0.3f, 1.5f, 0}})
      add_shared_quad(book.geometry, {0, 0.7f, -1}, {0, 0, 2}, page);
    add_shared_quad(book.geometry, {0, 0.7f, 1}, {0, 0, -2}, {0.9f, -0.4f, 0});
    book.light = light, book.camera = camera_at({2, 4, 6}, {0, 0, 0});
    add("non-manifold edge", std::move(book));
    Frame flipped;  // the ground faces down
    add_shared_quad(flipped.geometry, {-6, 0, -6}, {12, 0, 0}, {0, 0, 12});
    testing::add_box(flipped.geometry, {-1, 0.5f, -1}, {1, 1.5f, 1});
    flipped.light = light, flipped.camera = camera_at({2, 4, 6}, {0, 0, 0});
    add("ground that faces away", std::move(flipped));
  }
  for (const Light& light : {point_light({0.3f, 3, 2.5f}), directional_light({-0.4f, -1, -0.3f})}) {
    Frame room = box_on_ground(light);  // closed walls around the camera, and around the point light
    testing::add_box(room.geometry, {-6.5f, -0.5f, -6.5f}, {6.5f, 7, 6.5f});
    add("a mesh around the camera", std::move(room));
  }
  Frame behind = box_on_ground(point_light({4, 7, 11}));
  add("light behind the camera", std::move(behind));
  Frame spot = box_on_ground(testing::spot_light({1, 5, 2}, {0, 0, 0}, 25));
  add("spot", std::move(spot));
  Frame area = box_on_ground(testing::rectangle_light({1, 5, 2}, {0, 0, 0}, 1, 0.6f));
  add("rectangle from its centre", std::move(area));
  return scenes;
}

TEST(StencilShadowVolume, EveryVariantIsRightOnAwkwardGeometry) {
  int z_pass = 0;
  for (Named& s : awkward_scenes()) {
    SCOPED_TRACE(s.name);
    Stage stage(std::move(s.frame), 129, 95);
    std::vector<const char*> right{"z_fail", "zp_plus"};
    if (near_plane_is_clear(stage)) right.push_back("z_pass");
    z_pass += right.size() == 3;
    for (const char* variant : right)
      for (const char* extrusion : {"silhouette", "per_triangle"}) {
        SCOPED_TRACE(std::string(variant) + " " + extrusion);
        const Rendered r = stage.render(info, params(variant, extrusion));
        stage.expect_only_ties(r);
        EXPECT_LT(stage.share_off(r), 0.002);
      }
  }
  EXPECT_GT(z_pass, 8);
}

TEST(StencilShadowVolume, CameraInsideAVolumeIsRightButForZPass) {
  for (const Light& light : {point_light({0, 6, 0.5f}), directional_light({0, -1, 0.1f})}) {
    Frame f = box_on_ground(light);
    f.camera = camera_at({0.2f, 0.3f, 0.4f}, {3, 0, 3});  // under the box
    Stage stage(std::move(f), 128, 96);
    EXPECT_FALSE(near_plane_is_clear(stage));
    for (const char* extrusion : {"silhouette", "per_triangle"}) {
      for (const char* variant : {"z_fail", "zp_plus"})
        stage.expect_only_ties(stage.render(info, params(variant, extrusion)));
      EXPECT_GT(stage.share_off(stage.render(info, params("z_pass", extrusion))), 0.5)
          << "z-pass must miss the volume that holds the camera";
    }
  }
}

// A light behind the camera is nothing special to any variant; a closed mesh around the camera is right with
// all of them while the light is inside too, and wrong with z-pass when the light is outside, so that its
// volume holds the camera.
TEST(StencilShadowVolume, LightBehindTheCameraAndMeshesAroundItAreRightButForZPassInTheirVolume) {
  struct Situation {
    const char* name;
    Light light;
    bool room, clear;
  };
  for (const Situation& s :
       {Situation{"light behind", point_light({4, 7, 11}), false, true},
        Situation{"sun behind", directional_light({-0.3f, -0.7f, -1}), false, true},
        Situation{"room with a lamp", point_light({0.3f, 3, 2.5f}), true, true},
        Situation{"room under a lamp", point_light({2, 20, 3}), true, false},
        Situation{"room under a sun", directional_light({-0.4f, -1, -0.3f}), true, false}}) {
    SCOPED_TRACE(s.name);
    Frame f = box_on_ground(s.light);
    if (s.room) testing::add_box(f.geometry, {-6.5f, -0.5f, -6.5f}, {6.5f, 7, 6.5f});
    Stage stage(std::move(f), 128, 96);
    ASSERT_EQ(near_plane_is_clear(stage), s.clear);
    for (const char* extrusion : {"silhouette", "per_triangle"}) {
      for (const char* variant : {"z_fail", "zp_plus"})
        stage.expect_only_ties(stage.render(info, params(variant, extrusion)));
      const Rendered pass = stage.render(info, params("z_pass", extrusion));
      if (s.clear)
        stage.expect_only_ties(pass);
      else
        EXPECT_GT(stage.share_off(pass), 0.3) << "z-pass must miss the volume that holds the camera";
    }
  }
}

// Its near plane of 1.5 x 1.2 lies partly in the box, partly in the box's volume, partly in the light. In the
// second case the light is nearly in it.
class NearPlaneCuts : public ::testing::TestWithParam<Light> {};
INSTANTIATE_TEST_SUITE_P(StencilShadowVolume, NearPlaneCuts,
                         ::testing::Values(point_light({-3, 6, -2}), point_light({-3, 6, 0}),
                                           directional_light({0.6f, -1, 0.35f})));

TEST_P(NearPlaneCuts, VolumesAndMeshes) {
  Frame f = box_on_ground(GetParam());
  f.camera = camera_at({1.5f, 0.9f, 1.7f}, {1.5f, 0.7f, -3}, 1.4f);
  Stage stage(std::move(f), 160, 120);
  EXPECT_FALSE(near_plane_is_clear(stage));
  for (const char* extrusion : {"silhouette", "per_triangle"}) {
    SCOPED_TRACE(extrusion);
    const Rendered fail = stage.render(info, params("z_fail", extrusion));
    stage.expect_only_ties(fail);
    const Rendered plus = stage.render(info, params("zp_plus", extrusion));
    EXPECT_EQ(number(plus.counters, "fell_back"), 0);
    // ZP+ meets the near plane's cut by two roads, which may part by a pixel along it: streaks, which are
    // counted.
    const std::size_t off = stage.differing(plus.visibility, fail.visibility).size();
    std::printf("[measured] %zu pixels off, %.0f streak pixels\n", off,
                number(plus.counters, "streak_pixels"));
    EXPECT_LE(double(off), number(plus.counters, "streak_pixels"));
    EXPECT_LE(number(plus.counters, "streak_pixels"), 160);
    EXPECT_LE(off, 160U);
    const double wrong = stage.share_off(stage.render(info, params("z_pass", extrusion)));
    EXPECT_GT(wrong, 0.01);
    EXPECT_LT(wrong, 0.9);
  }
}

// A triangle that the near plane cuts must have the depths of its cap all the same.
TEST(StencilShadowVolume, SurfaceCutByTheNearPlaneDoesNotShadowItself) {
  Frame f;
  testing::add_triangle(f.geometry, {-9.1f, 0.3f, 5.3f}, {8.7f, -0.4f, 6.1f}, {0.3f, 0.2f, -14.2f});
  f.light = point_light({0.7f, 5.3f, 0.4f}),
  f.camera = camera_at({0.13f, 0.71f, 3.1f}, {0.4f, 0.1f, -3.3f}, 1.37f);
  Stage stage(std::move(f), 160, 120);
  for (const char* variant : {"z_pass", "z_fail", "zp_plus"})
    EXPECT_TRUE(stage.differing(stage.render(info, params(variant))).empty()) << variant;
}

TEST(StencilShadowVolume, ZpPlusFallsBackWhereTheLightIsInTheNearPlane) {
  Frame f = box_on_ground(point_light({0, 5, 3}));
  f.camera = camera_at({0, 1, 4}, {0, 1, 0}, 1);  // near plane: z = 3
  Stage stage(std::move(f), 96, 64);
  const Rendered r = stage.render(info, params("zp_plus"));
  EXPECT_EQ(number(r.counters, "fell_back"), 1);
  stage.expect_only_ties(r);
}

TEST(StencilShadowVolume, ClosedMeshesNeedOnlyTrianglesThatTurnTheirBackToTheLight) {
  Frame f = Scene::load("torus_knot", {"configs/scenes"}).frame(0, "lamp", "front", -1);
  Geometry& g = f.geometry;
  EXPECT_FALSE(g.closed);  // the ground plane is open
  Stage open(std::move(f), 64, 64);
  EXPECT_TRUE(Stage::make(info, params("z_fail", "silhouette", "light_back_facing"))
                  ->supports(open.the_case)
                  .has_value());
  Frame closed;
  testing::add_box(closed.geometry, {-5, -1, -5}, {5, 0, 5});
  testing::add_box(closed.geometry, {-1, 0.5f, -1}, {1, 1.5f, 1});
  closed.geometry.closed = true;
  closed.light = point_light({1.5f, 5, 1}), closed.camera = camera_at({2, 4, 6}, {0, 0, 0});
  Stage stage(std::move(closed), 128, 96);
  const Rendered all = stage.render(info, params("z_fail"));
  const Rendered back = stage.render(info, params("z_fail", "silhouette", "light_back_facing"));
  stage.expect_only_ties(back);
  EXPECT_LT(number(back.counters, "fragments"), 0.6 * number(all.counters, "fragments"));
}

TEST(StencilShadowVolume, TwoHundredFiftySixVolumesWrapTheStencilWhereItIsAskedFor) {
  Stage stage(pile(directional_light({0, -1, 0})), 96, 64);
  ParamValues given = params("z_fail", "per_triangle");
  given["counter"] = std::string("stencil");
  const Rendered r = stage.render(info, given);
  EXPECT_EQ(number(r.counters, "largest_count"), 256);
  EXPECT_GT(number(r.counters, "wrapped_pixels"), 20);
  EXPECT_NEAR(double(stage.differing(r).size()), number(r.counters, "wrapped_pixels"), 8)
      << "wrong exactly where the count wraps to 0";
}

TEST(StencilShadowVolume, TwoHundredFiftySixVolumesAreCountedInFloatsOtherwise) {
  for (const Light& light : {directional_light({0, -1, 0}), point_light({0.1f, 9, 0.2f})}) {
    Stage stage(pile(light), 96, 64);
    for (const char* variant : {"z_pass", "z_fail", "zp_plus"})
      for (const char* extrusion : {"silhouette", "per_triangle"}) {
        SCOPED_TRACE(std::string(variant) + " " + extrusion);
        const Rendered r = stage.render(info, params(variant, extrusion));
        stage.expect_only_ties(r);
        EXPECT_EQ(number(r.counters, "wide_counts"), 1);
        EXPECT_GT(number(r.counters, "layer_bound"), 250);
        EXPECT_EQ(number(r.counters, "wrapped_pixels"), 0);
      }
  }
}

TEST(StencilShadowVolume, FloatsCountAsTheStencilDoes) {
  Stage stage(box_on_ground(point_light({1.5f, 5, 1})), 129, 95);
  for (const char* variant : {"z_pass", "z_fail", "zp_plus"}) {
    ParamValues given = params(variant);
    const Rendered narrow = stage.render(info, given);
    EXPECT_EQ(number(narrow.counters, "wide_counts"), 0) << "26 triangles cannot wrap it";
    given["counter"] = std::string("wide");
    EXPECT_EQ(stage.render(info, given).visibility, narrow.visibility);
  }
}

TEST(StencilShadowVolume, SecondFrameAllocatesNothingAndGivesTheSameBits) {
  Stage stage(box_on_ground(point_light({1.5f, 5, 1})), 100, 60);
  for (const char* variant : {"z_pass", "z_fail", "zp_plus"}) {
    const std::unique_ptr<Technique> t = stage.built(info, params(variant));
    stage.render_only(*t);
    const uint64_t held = device().allocated_bytes();
    EXPECT_GT(t->structure_bytes(), 0U);
    stage.render_only(*t);
    EXPECT_EQ(device().allocated_bytes(), held);
    EXPECT_EQ(stage.render(*t).visibility, stage.render(*t).visibility);
  }
}

// Mask bits, each of them a hard shadow.
TEST(StencilShadowVolumePerSample, DiffersFromTheReferenceOnlyInTies) {
  for (const Light& light : {testing::rectangle_light({1, 5, 2}, {0, 0, 0}, 1.5f, 1),
                             testing::rectangle_light({0.2f, 1.0f, 3}, {0, 0.9f, 0}, 1.2f, 0.8f)})
    for (const char* variant : {"z_fail", "zp_plus"}) {
      SCOPED_TRACE(variant);
      Stage stage(box_on_ground(light), 121, 83);
      stage.light_samples = make_light_samples(light, {7, 5});
      const std::unique_ptr<Technique> t =
          stage.built(stencil_shadow_volume_per_sample_technique(), params(variant));
      const Rendered m = stage.render(*t, true);
      std::size_t compared = 0;
      const std::size_t off = stage.differing_bits(m, &compared);
      std::printf("[measured] %zu of %zu bits differ\n", off, compared);
      EXPECT_GT(compared, 100000U);
      EXPECT_LT(double(off), 0.002 * double(compared));
      double partial = 0;
      for (std::size_t i = 0; i < stage.pixels(); ++i) {
        const int blocked = std::popcount(m.mask[2 * i]) + std::popcount(m.mask[2 * i + 1]);
        EXPECT_NEAR(double{m.visibility[i]}, (35.0 - blocked) / 35, 1e-5);
        EXPECT_EQ(m.mask[2 * i + 1] >> 3, 0U) << "bits past the count";
        partial += blocked > 0 && blocked < 35;
      }
      EXPECT_GT(partial, 200);
      const uint64_t held = device().allocated_bytes();
      stage.render_only(*t, true);
      EXPECT_EQ(device().allocated_bytes(), held);
    }
}

}  // namespace
}  // namespace penumbra::test
