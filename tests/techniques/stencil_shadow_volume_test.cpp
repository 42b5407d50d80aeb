// Shadow volumes against Embree at the view samples themselves, and against the lecture's test of each point
// against each triangle's volume.
#include "techniques/stencil_shadow_volume/stencil_shadow_volume.h"

#include <bit>
#include <map>

#include "near_plane_clear.h"
#include "stencil_planar_stage.h"
#include "techniques/stencil_shadow_volume/layers.h"
#include "techniques/stencil_shadow_volume/near_plane.h"
#include "techniques/stencil_shadow_volume/volumes.h"

namespace penumbra::test {
namespace {

const TechniqueInfo info = stencil_shadow_volume_technique();

ParamValues params(const std::string& variant, const std::string& extrusion = "silhouette",
                   const std::string& casters = "all") {
  return {{"variant", variant}, {"extrusion", extrusion}, {"casters", casters}};
}

Frame box_on_ground(const Light& light) {
  Frame f;
  testing::add_ground(f.geometry, 6);
  testing::add_box(f.geometry, {-1, 0.5f, -1}, {1, 1.5f, 1});
  f.light = light;
  f.camera = camera_at({2, 4, 6}, {0, 0, 0});
  return f;
}

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

// Two boxes apart from each other: seen from along an axis, a box shows a square of 4 silhouette edges, each
// with the sides of a triangle that faces the light and of one that does not.
TEST(StencilShadowVolume, CountsQuadsAndSilhouetteEdges) {
  Frame f;
  testing::add_box(f.geometry, {-1, 0, -1}, {1, 1, 1});
  testing::add_box(f.geometry, {2, 0, -1}, {3, 1, 1});
  f.light = point_light({0.1f, 9, 0.2f}), f.camera = camera_at({2, 4, 6}, {0, 0, 0});
  Stage stage(std::move(f), 64, 48);
  const Rendered s = stage.render(info, params("z_fail"));
  // The second box shows the light its top and one side: 6 edges around them.
  EXPECT_EQ(number(s.counters, "silhouette_edges"), 4 + 6);
  EXPECT_EQ(number(s.counters, "quads"), 2 * (4 + 6));
  const Rendered t = stage.render(info, params("z_fail", "per_triangle"));
  EXPECT_EQ(number(t.counters, "quads"), 3 * 24);
  EXPECT_GT(number(t.counters, "fragments"), number(s.counters, "fragments"));
  EXPECT_NEAR(number(s.counters, "overdraw"), number(s.counters, "fragments") / (64 * 48), 1e-9);
}

// 256 triangles over each other above the ground.
Frame pile(const Light& light) {
  Frame f;
  testing::add_ground(f.geometry, 6);
  for (int i = 0; i < 256; ++i) {
    const float y = 1 + float(i) * 0.005f;
    testing::add_triangle(f.geometry, {-1, y, -1}, {0, y, 2}, {1, y, -1});
  }
  f.light = light, f.camera = camera_at({4, 5, 5}, {0, 0, 0});
  return f;
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

// It never proves fewer than some ray meets, and proves a few times as many.
TEST(MostLayers, BoundsWhatAnyRayFromTheLightMeets) {
  using shadow_volume::most_layers;
  const uint32_t piled = most_layers(pile(directional_light({0, -1, 0})).geometry, {0, 1, 0, 0}, 256);
  EXPECT_GE(piled, 257U);  // with the ground
  EXPECT_LE(piled, 258U);  // whose two triangles meet
  Geometry soup;
  testing::add_soup(soup, {-3, -3, -3}, {3, 3, 3}, 4000, 0.9f, 5);
  const testing::TriangleTree tree(soup);
  for (const Vec4d light : {Vec4d{0.2, 9, -0.3, 1}, Vec4d{0.2, 0.4, -0.3, 1}, Vec4d{0.6, 0.8, 0, 0}}) {
    uint32_t most = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d through(soup.positions[std::size_t(i) * 5]);
      const Vec3d along = light.w != 0 ? (through - light.xyz()) * 30.0 : light.xyz() * 30.0;
      const testing::Segment s{light.w != 0 ? light.xyz() : through - light.xyz() * 15.0, along};
      uint32_t met = 0;
      tree.visit(s, 0, [&](uint32_t t) {
        met += testing::meet(s, tree.triangle(t)).has_value();
        return false;
      });
      most = std::max(most, met);
    }
    ASSERT_GT(most, 10U);
    EXPECT_GE(most_layers(soup, light, most - 1), most);
    EXPECT_LE(most_layers(soup, light, 6 * most), 6 * most);
  }
}

TEST(MostLayers, ProvesThatTheStencilIsEnoughForClosedMeshes) {
  const Frame f = Scene::load("bunny", {"configs/scenes"}).frame(0, "lamp", "", -1);
  const Vec3d l(f.light.center);
  const uint32_t bound = shadow_volume::most_layers(f.geometry, {l.x, l.y, l.z, 1}, 250);
  std::printf("[measured] bunny: at most %u layers\n", bound);
  EXPECT_LE(bound, 250U);
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

// The slope of a sliver's depth is sound only where its short edge comes first (see shaders/append.glsl); and
// sides that cancel have to be the same triangles, with these first two corners exchanged.
TEST(StencilShadowVolume, SidesBeginAtTheirShortEdgeAndCancelAsTriangles) {
  for (const Light& light : {point_light({1.5f, 5, 1}), directional_light({-0.4f, -1, -0.3f})}) {
    Stage stage(box_on_ground(light), 8, 8);
    shadow_volume::Params p;
    p.extrusion = shadow_volume::Extrusion::per_triangle;
    shadow_volume::Volumes volumes(p);
    volumes.setup(device());
    volumes.build(stage.the_case, stage.passes);
    volumes.extract(stage.the_case, light_emission(light), shadow_volume::Variant::z_fail, stage.passes);
    stage.passes.take_times();
    const uint32_t list = shadow_volume::LIST_SIDES, n = stage.geometry.vertex_count;
    std::vector<uint32_t> index(volumes.read_draws().list[list].index_count);
    gpu::download(stage.passes, "download", volumes.indices(list), index.data(), 4 * index.size());
    ASSERT_GT(index.size(), 100U);
    // By place: the vertices of a box are not shared between its faces.
    const auto place = [&](uint32_t v) {
      const Vec3f q = stage.frame.geometry.positions[v % n];
      return std::array<float, 4>{q.x, q.y, q.z, v < n ? 0.0f : 1.0f};
    };
    std::map<std::array<std::array<float, 4>, 3>, int> triangles;
    for (std::size_t i = 0; i < index.size(); i += 3) {
      const bool first = index[i] < n;
      EXPECT_NE(first == (index[i + 1] < n), first == (index[i + 2] < n))
          << "no short edge at the first corner";
      ++triangles[{place(index[i]), place(index[i + 1]), place(index[i + 2])}];
    }
    int cancelling = 0, left = 0;
    for (const auto& [t, count] : triangles) {
      const auto opposite = triangles.find({t[0], t[2], t[1]});
      const int other = opposite == triangles.end() ? 0 : opposite->second;
      cancelling += std::min(count, other), left += std::max(count - other, 0);
    }
    // Of the ground's diagonal and the box's edges between faces on one side of the light: both sides cancel.
    const shadow_volume::Params silhouettes;
    shadow_volume::Volumes fewer(silhouettes);
    fewer.setup(device());
    fewer.build(stage.the_case, stage.passes);
    fewer.extract(stage.the_case, light_emission(light), shadow_volume::Variant::z_pass, stage.passes);
    stage.passes.take_times();
    EXPECT_GT(cancelling, 10);
    EXPECT_EQ(uint32_t(left) * 3, fewer.read_draws().list[list].index_count) << "what silhouettes draw";
  }
}

TEST(StencilShadowVolume, EdgesAreFoundAnewWhenWeldedVerticesPart) {
  Frame f = box_on_ground(point_light({1.5f, 5, 1}));
  testing::add_box(f.geometry, {1, 0.5f, -1}, {2, 1.5f, 1});  // shares a face with the first
  Stage stage(std::move(f), 128, 96);
  const std::unique_ptr<Technique> t = stage.built(info, params("z_fail"));
  stage.expect_only_ties(stage.render(*t));
  Stage moved(stage.frame, 128, 96);
  const std::size_t box = 36;  // vertices of a box
  std::vector<Vec3f>& p = moved.frame.geometry.positions;
  for (std::size_t v = p.size() - box; v < p.size(); ++v) p[v] += Vec3f{0.7f, 0.3f, 0};
  moved.frame.changes = {false, true, false, false};
  moved.geometry.update(device(), moved.frame, moved.passes);
  moved.view.render(moved.frame, moved.geometry, moved.passes);
  t->build(moved.the_case, moved.passes);
  moved.expect_only_ties(moved.render(*t));
}

TEST(NearPlane, SeesWhatLiesBetweenItsPointsAndTheLight) {
  const Camera c = camera_at({1, 2, 5}, {0, 0.5f, 0}, 0.3f);
  Box bounds;
  bounds.extend({-10, -10, -10}), bounds.extend({10, 10, 10});
  for (const Vec4d light :
       {Vec4d{3, 6, -2, 1}, Vec4d{2, 4, 9, 1}, Vec4d{0.6, 0.8, 0, 0}, Vec4d{0, 0.6, 0.8, 0}}) {
    const auto m = shadow_volume::near_plane_from_light(c, 200, 100, light, bounds);
    ASSERT_TRUE(m.has_value());
    for (double x : {10.5, 100.5, 190.5})
      for (double y : {5.5, 70.5}) {
        const Vec3d on_plane = Vec3d(c.eye) + c.ray_direction(x, y, 200, 100) * double{c.near_plane};
        const Vec3d along = light.xyz() - on_plane * light.w;
        for (double t : {-0.3, 1e-6, 0.3, 0.9, 1.2}) {
          const Vec3d q = on_plane + along * t;
          const Vec4d clip = *m * Vec4d{q.x, q.y, q.z, 1};
          const bool between = t > 0 && (light.w == 0 || t < 1);
          EXPECT_EQ(clip.w > 0 && clip.z >= 0 && clip.z <= clip.w, between) << t;
          if (!between) continue;
          EXPECT_NEAR((clip.x / clip.w * 0.5 + 0.5) * 200, x, 1e-6);
          EXPECT_NEAR((clip.y / clip.w * 0.5 + 0.5) * 100, y, 1e-6);
        }
      }
  }
}

}  // namespace
}  // namespace penumbra::test
