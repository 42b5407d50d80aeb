// What shadow volumes are drawn from: the lists of sides and edges, how many volumes may lie over each other,
// and the light's view of the near plane.
#include <map>

#include "stencil_shadow_volume_frames.h"
#include "techniques/stencil_shadow_volume/layers.h"
#include "techniques/stencil_shadow_volume/near_plane.h"
#include "techniques/stencil_shadow_volume/volumes.h"

namespace penumbra::test {
namespace {

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
