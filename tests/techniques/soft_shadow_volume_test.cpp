// soft_shadow_volume against closed forms in double precision: exact where its two assumptions hold, and off
// by what they say where they do not.
#include "techniques/soft_shadow_volume/soft_shadow_volume.h"

#include <algorithm>
#include <functional>

#include "scene/generators.h"
#include "tests/support/analytic.h"
#include "tests/support/host_view.h"
#include "tests/support/stage.h"

namespace penumbra {
namespace {

using testing::camera_at;
using testing::number;
using testing::Polygon;
using testing::Rendered;
using testing::Stage;

constexpr int width = 131, height = 97;  // odd and not square

struct Box3 {
  Vec3f lo, hi;
};

Light sphere_light(Vec3f center, float radius) {
  Light l;
  l.kind = LightKind::sphere, l.center = center, l.radius = radius;
  return l;
}

Frame boxes(const std::vector<Box3>& all, const Light& light, const Camera& camera) {
  Frame f;
  testing::add_ground(f.geometry, 4);
  for (const Box3& b : all) testing::add_box(f.geometry, b.lo, b.hi);
  f.light = light, f.camera = camera;
  return f;
}

const Box3 box{{-0.5f, 0.3f, -0.4f}, {0.4f, 0.9f, 0.5f}};
const Camera front = camera_at({0.4f, 2.6f, 3.4f}, {0, 0.3f, -0.2f});
const Light rectangle = testing::rectangle_light({2.1f, 3.3f, 1.9f}, {0, 0.4f, 0}, 1.3f, 0.8f);
const Light sphere = sphere_light({2.1f, 3.3f, 1.9f}, 0.6f);

// An uneven light of 5 x 3 texels.
Light textured(Light light) {
  light.kind = LightKind::textured_rectangle, light.texture_width = 5, light.texture_height = 3;
  light.weights = {1, 0, 2, 0.5f, 4, 0, 3, 0.25f, 1, 0, 2, 2, 0, 6, 1};
  return light;
}

// Texel by texel.
double textured_visibility(const Light& light, Vec3d p, Vec3d n, const std::vector<Polygon>& occluders) {
  double seen = 0, sum = 0;
  for (int row = 0; row < light.texture_height; ++row)
    for (int column = 0; column < light.texture_width; ++column) {
      const float w = static_cast<float>(light.texture_width), h = static_cast<float>(light.texture_height);
      Light texel = light;
      texel.kind = LightKind::rectangle, texel.edge_u = light.edge_u / w, texel.edge_v = light.edge_v / h;
      texel.center = light.at((static_cast<float>(column) + 0.5f) / w, (static_cast<float>(row) + 0.5f) / h);
      const double weight{light.weights[static_cast<std::size_t>(row * light.texture_width + column)]};
      sum += weight;
      if (weight > 0) seen += weight * testing::rectangle_visibility(texel, p, n, occluders);
    }
  return seen / sum;
}

// Visibility of the whole light, whatever its shape.
double visibility(const Light& light, Vec3d p, Vec3d n, const std::vector<Polygon>& occluders) {
  return light.kind == LightKind::sphere
             ? testing::disc_visibility(Vec3d(light.center), double(light.radius), p, n, occluders)
         : light.kind == LightKind::textured_rectangle
             ? textured_visibility(light, p, n, occluders)
             : testing::rectangle_visibility(light, p, n, occluders);
}

struct Agreement {
  double worst = 0, mean = 0, signed_mean = 0;
  int umbra = 0, penumbra = 0, lit = 0, pixels = 0, off = 0;  // off: by more than 1e-5
  int low = 0,
      covered = 0;  // the light is partly below the horizon; and of these, something hides a part of it
};

// `truth`: visibility at a view sample, below 0 where none is claimed.
Agreement compare(const Stage& stage, const Rendered& r,
                  const std::function<double(std::size_t pixel, Vec3d p, Vec3d n)>& truth) {
  const ViewSamplesHost& view = stage.view.host();
  Agreement a;
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    if (view.triangle[i] == no_triangle) continue;
    const Vec3d p(view.position[i].xyz()), n(view.geometric_normal[i].xyz());
    const double horizon = visibility(stage.frame.light, p, n, {});
    if (horizon <= 0) continue;
    const double t = truth(i, p, n), error = double(r.visibility[i]) - t;
    if (t < -0.5) continue;
    a.worst = std::max(a.worst, std::abs(error));
    a.off += std::abs(error) > 1e-5;
    a.mean += std::abs(error), a.signed_mean += error;
    a.umbra += t<1e-9, a.lit += t> 1 - 1e-9, a.penumbra += t > 0.01 && t < 0.99;
    const bool low = horizon < 0.99 && horizon > 0.01;
    a.low += low, a.covered += low && t < horizon - 1e-3;
    ++a.pixels;
  }
  a.mean /= a.pixels, a.signed_mean /= a.pixels;
  return a;
}

// Of a convex solid's triangles those that face a view sample: disjoint as seen from there.
void add_faces_towards(Vec3d p, const Geometry& g, uint32_t first, uint32_t end, std::vector<Polygon>& out) {
  for (uint32_t t = first; t < end; ++t) {
    const Vec3d a(g.corner(t, 0)), b(g.corner(t, 1)), c(g.corner(t, 2));
    if (dot(cross(b - a, c - a), p - a) > 0) out.push_back({a, b, c});
  }
}

// Convex solids hide the light, each from triangle solids[i] to solids[i + 1]; seen from any view sample they
// must not overlap. One that a view sample lies on does not count: its horizon says it all.
Agreement against_solids(const Stage& stage, const Rendered& r, const std::vector<uint32_t>& solids) {
  return compare(stage, r, [&](std::size_t pixel, Vec3d p, Vec3d n) {
    const uint32_t own = stage.view.host().triangle[pixel];
    std::vector<Polygon> occluders;
    for (std::size_t i = 0; i + 1 < solids.size(); ++i)
      if (own < solids[i] || own >= solids[i + 1])
        add_faces_towards(p, stage.frame.geometry, solids[i], solids[i + 1], occluders);
    return visibility(stage.frame.light, p, n, occluders);
  });
}

// The boxes of boxes(), after the ground's two triangles.
Agreement against_boxes(const Stage& stage, const Rendered& r, std::size_t count) {
  std::vector<uint32_t> solids;
  for (std::size_t i = 0; i <= count; ++i) solids.push_back(static_cast<uint32_t>(2 + 12 * i));
  return against_solids(stage, r, solids);
}

// What the method computes, by its definition: casters from triangle `first` on that turn their back to the
// light's centre hide the light, each for itself, and what they hide is added up.
double by_definition(const Light& light, const Geometry& g, uint32_t first, uint32_t own, Vec3d p, Vec3d n) {
  const double open = visibility(light, p, n, {});
  double hidden = 0;
  for (uint32_t t = first; t < g.triangle_count(); ++t) {
    const Vec3d a(g.corner(t, 0)), b(g.corner(t, 1)), c(g.corner(t, 2)), normal = cross(b - a, c - a);
    if (t == own || dot(normal, Vec3d(light.center) - a) >= 0) continue;
    const double part = open - visibility(light, p, n, {{a, b, c}});
    hidden += dot(normal, p - a) > 0 ? part : -part;
  }
  return std::clamp(open - hidden, 0.0, open);
}

// Leaves out view samples that see a closed mesh from its inside, in a gap that rasterisation left at a
// silhouette.
Agreement against_definition(const Stage& stage, const Rendered& r, uint32_t first) {
  return compare(stage, r, [&](std::size_t pixel, Vec3d p, Vec3d n) {
    const Geometry& g = stage.frame.geometry;
    const uint32_t t = stage.view.host().triangle[pixel];
    const Vec3d a(g.corner(t, 0)), b(g.corner(t, 1)), c(g.corner(t, 2));
    if (t >= first && dot(cross(b - a, c - a), n) < 0) return -1.0;
    return by_definition(stage.frame.light, stage.frame.geometry, first, stage.view.host().triangle[pixel], p,
                         n);
  });
}

Agreement one_box(const Light& light, const Camera& camera, const ParamValues& given) {
  Stage stage(boxes({box}, light, camera), width, height);
  return against_boxes(stage, stage.render(soft_shadow_volume_technique(), given), 1);
}

void expect_exact(const Agreement& a, double tolerance = 1e-5) {
  EXPECT_LT(a.worst, tolerance);
  EXPECT_GT(a.penumbra, 100);
  EXPECT_GT(a.lit, 100);
}

// Every plane of the box has the whole light on one side: all of the light sees the same silhouette.
bool one_silhouette(const Light& light, const Box3& b) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float plane : {b.lo[axis], b.hi[axis]}) {
      const float reach = light.kind == LightKind::sphere
                              ? light.radius
                              : (std::abs(light.edge_u[axis]) + std::abs(light.edge_v[axis])) / 2;
      if (std::abs(light.center[axis] - plane) <= reach) return false;
    }
  return true;
}

TEST(SoftShadowVolume, OneConvexOccluderIsExact) {
  for (const Light& light : {rectangle, sphere, textured(rectangle)}) {
    ASSERT_TRUE(one_silhouette(light, box));
    for (const char* wedges : {"tight", "loose"}) {
      const Agreement a = one_box(light, front, {{"wedges", wedges}});
      expect_exact(a);
      EXPECT_GT(a.umbra, 100);
    }
  }
}

TEST(SoftShadowVolume, SplitLightsAreExactToo) {
  for (const Light& light : {rectangle, textured(rectangle)})
    for (const int64_t split : {2, 3}) expect_exact(one_box(light, front, {{"split", split}}));
}

void add_octahedron(Geometry& g, Vec3f center, float radius) {
  const Vec3f x{radius, 0, 0}, y{0, radius, 0}, z{0, 0, radius};
  for (const float sx : {-1.f, 1.f})
    for (const float sy : {-1.f, 1.f})
      for (const float sz : {-1.f, 1.f}) {
        const Vec3f a = center + x * sx, b = center + y * sy, c = center + z * sz;
        if (sx * sy * sz > 0)
          testing::add_triangle(g, a, b, c);
        else
          testing::add_triangle(g, a, c, b);
      }
}

// A low light that reaches below the floor: what is above lights the floor. The floor is a closed slab.
TEST(SoftShadowVolume, LightBelowTheHorizonCountsForNothing) {
  for (const float middle : {0.3f, 0.f, -0.2f})  // the last two: the light's centre itself gives no light
    for (Light light : {testing::rectangle_light({5, middle, 0.3f}, {0, 0.4f, 0}, 1.6f, 1.2f),
                        textured(testing::rectangle_light({5, middle, 0.3f}, {0, 0.4f, 0}, 1.6f, 1.2f)),
                        sphere_light({5, middle, 0.3f}, 0.7f)}) {
      Frame f;
      testing::add_box(f.geometry, {-4, -1, -4}, {4, -1e-3f, 4});
      add_octahedron(f.geometry, {0.3f, 0.45f, 0}, 0.4f);
      f.camera = camera_at({0.4f, 3.6f, 3.4f}, {-0.6f, 0, -0.1f}), f.light = light;
      Stage stage(f, width, height);
      const Rendered r = stage.render(soft_shadow_volume_technique(), {});
      // The slab's upper side cuts the light: what lies above it sees the slab in two silhouettes.
      const Agreement a = compare(stage, r, [&](std::size_t pixel, Vec3d p, Vec3d n) {
        if (stage.view.host().triangle[pixel] >= 12) return -1.0;
        std::vector<Polygon> occluders;
        add_faces_towards(p, f.geometry, 12, 20, occluders);
        return visibility(light, p, n, occluders);
      });
      EXPECT_GT(a.low, 2000) << middle;
      EXPECT_GT(a.covered, 500) << middle;
      EXPECT_LT(a.worst, 1e-5) << middle;
    }
}

// The eye between the light's edge and a silhouette edge, and in the umbra itself.
TEST(SoftShadowVolume, CameraInsideAWedgeOrAVolume) {
  const std::vector<Camera> inside{camera_at({-0.62f, 0.21f, -0.22f}, {-0.9f, 0, -0.9f}),
                                   camera_at({-0.5f, 0.12f, -0.4f}, {-1.5f, 0, 0.4f}),
                                   camera_at({-0.2f, 0.05f, -0.2f}, {0.9f, 0, 1.2f})};
  double in_volume = 0;
  for (const Light& light : {rectangle, sphere})
    for (const Camera& camera : inside) {
      Stage stage(boxes({box}, light, camera), width, height);
      const Rendered r = stage.render(soft_shadow_volume_technique(), {});
      expect_exact(against_boxes(stage, r, 1));
      in_volume += number(r.counters, "eye_volumes");
    }
  EXPECT_GT(in_volume, 0);
}

// A near plane that cuts away the part of the box that is next to the eye: what is cut still casts.
TEST(SoftShadowVolume, NearPlaneCutsCastersAndWedges) {
  Camera camera = camera_at({0.1f, 1.25f, 1.0f}, {-0.5f, 0, -0.8f}, 0.75f);
  for (const Light& light : {rectangle, sphere}) {
    Stage stage(boxes({box}, light, camera), width, height);
    const Rendered r = stage.render(soft_shadow_volume_technique(), {});
    const Agreement a = against_boxes(stage, r, 1);
    EXPECT_GT(number(r.counters, "near_caps"), 0);
    expect_exact(a);
  }
}

// Under a plate hangs a smaller one that no view sample on the ground sees past it: it hides nothing more.
const std::vector<Box3> plates{{{-0.7f, 1.0f, -0.6f}, {0.5f, 1.1f, 0.6f}},
                               {{-0.35f, 0.85f, -0.3f}, {0.2f, 0.95f, 0.3f}}};

TEST(SoftShadowVolume, OverlapIsAddedUpAndLessSoInASplitLight) {
  Stage stage(boxes(plates, rectangle, front), width, height);
  std::vector<double> error;
  for (const int64_t split : {1, 2, 3}) {
    const Rendered r = stage.render(soft_shadow_volume_technique(), {{"split", split}});
    // The truth on the ground is the upper plate's shadow alone.
    const Agreement a = compare(stage, r, [&](std::size_t pixel, Vec3d p, Vec3d n) {
      if (stage.view.host().triangle[pixel] >= 2) return -1.0;
      std::vector<Polygon> upper;
      add_faces_towards(p, stage.frame.geometry, 2, 14, upper);
      return visibility(rectangle, p, n, upper);
    });
    EXPECT_NEAR(a.signed_mean, -a.mean, 1e-6) << "too dark, nowhere too light";
    error.push_back(a.mean);
    if (split == 1) {
      EXPECT_GT(a.worst, 0.1);
      EXPECT_LT(against_definition(stage, r, 2).worst, 1e-5) << "too dark by what the lower plate hides";
    }
  }
  EXPECT_GT(error[0], 1e-3);
  EXPECT_LT(error[1], 0.9 * error[0]);
  EXPECT_LT(error[2], 0.9 * error[1]);
}

// A light before an edge of the box, which its parts see in different silhouettes.
TEST(SoftShadowVolume, OneSilhouetteForAllIsWrongAndLessSoInASplitLight) {
  const Light light = testing::rectangle_light({0.5f, 3.3f, 0.6f}, {0, 0, 0.1f}, 1.6f, 1.6f);
  EXPECT_FALSE(one_silhouette(light, box));
  Stage stage(boxes({box}, light, front), width, height);
  std::vector<double> error;
  for (const int64_t split : {1, 3, 8}) {
    const Rendered r = stage.render(soft_shadow_volume_technique(), {{"split", split}});
    error.push_back(against_boxes(stage, r, 1).mean);
    if (split == 1) {
      EXPECT_LT(against_definition(stage, r, 2).worst, 1e-5);
    }
  }
  EXPECT_GT(error[0], 1e-4);
  for (std::size_t i = 1; i < error.size(); ++i) EXPECT_LT(error[i], error[i - 1]) << i;
}

Geometry torus(int segments, int sides) {
  const Mesh mesh = generate("torus", {{"segments", double(segments)}, {"sides", double(sides)}});
  Geometry g;
  testing::add_ground(g, 4, -1.4f);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    testing::add_triangle(g, mesh.positions[mesh.indices[3 * t]], mesh.positions[mesh.indices[3 * t + 1]],
                          mesh.positions[mesh.indices[3 * t + 2]]);
  return g;
}

TEST(SoftShadowVolume, CurvedMeshesAreAsTheMethodDefines) {
  for (const Light& light : {rectangle, sphere}) {
    Frame f;
    f.geometry = torus(14, 9), f.light = light;
    f.camera = camera_at({0.4f, 2.6f, 4.4f}, {0, -0.5f, -0.2f});
    Stage stage(f, 83, 61);
    const Agreement a = against_definition(stage, stage.render(soft_shadow_volume_technique(), {}), 2);
    EXPECT_LT(a.worst, 2e-5);
    EXPECT_GT(a.penumbra, 200);
  }
}

// A wall that reaches beyond the light's plane: what lies behind that hides nothing.
TEST(SoftShadowVolume, EdgesThroughTheLightsPlane) {
  const Box3 wall{{-1.3f, 0.2f, -1.1f}, {-1.0f, 9, 1.0f}};
  for (const Light& light : {rectangle, sphere}) {
    Stage stage(boxes({wall}, light, front), width, height);
    const Rendered r = stage.render(soft_shadow_volume_technique(), {});
    const Agreement a = against_definition(stage, r, 2);
    EXPECT_LT(a.worst, 3e-5);  // edges of 9 units, of which a thousandth is before the light
    EXPECT_GT(a.penumbra, 50);
    if (light.kind == LightKind::rectangle) {
      EXPECT_GT(number(r.counters, "whole_picture_wedges"), 0);
    }
  }
}

// The light's centre in the lines of the box's edges and in its planes.
TEST(SoftShadowVolume, LightsCentreInTheLineOfAnEdge) {
  Light above;
  above.kind = LightKind::rectangle, above.center = {0.5f, 3, 0.5f};
  above.edge_u = {1, 0, 0}, above.edge_v = {0, 0, 1}, above.direction = {0, -1, 0};
  const Box3 cube{{-0.5f, 0.25f, -0.5f}, {0.5f, 1, 0.5f}};
  for (const Light& light : {above, sphere_light({0.5f, 3, 0.5f}, 0.5f)})
    for (const float x : {0.7f, 0.5f}) {
      Stage stage(boxes({cube}, light, camera_at({x, 2.5f, 3.5f}, {0.5f, 0, 0})), width, height);
      const Agreement a = against_definition(stage, stage.render(soft_shadow_volume_technique(), {}), 2);
      // With the eye in the plane of centre and edge, view samples lie in it too: one of them is a tie.
      EXPECT_LE(a.off, x == 0.5f ? 1 : 0);
      EXPECT_GT(a.penumbra, 100);
    }
}

TEST(SoftShadowVolume, TablesNearArithmeticAsTheyGrow) {
  for (const Light& light : {rectangle, sphere}) {
    double before = 1;
    for (const int64_t size : {16, 64, 256}) {
      const Agreement a = one_box(light, front, {{"coverage", "table"}, {"table_size", size}});
      EXPECT_LT(a.worst, std::max(0.5 * before, 1e-5)) << size;
      before = a.worst;
    }
    EXPECT_LT(before, 2e-3);
  }
}

TEST(SoftShadowVolume, PointLightsGiveTheHardShadow) {
  Stage stage(boxes({box}, testing::point_light({2.1f, 3.3f, 1.9f}), front), width, height);
  const Rendered r = stage.render(soft_shadow_volume_technique(), {});
  const MatchedReference& truth = stage.reference(ReferenceOrigin::exact);
  int off = 0, dark = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i)
    if (truth.evaluated[i]) off += truth.visibility[i] != r.visibility[i], dark += r.visibility[i] == 0;
  EXPECT_LE(off, 2);
  EXPECT_GT(dark, 300);
}

TEST(SoftShadowVolume, OpenMeshesAreRefusedUnlessTheyAreAFloor) {
  Frame f = boxes({box}, rectangle, front);
  const auto refusal = [&] {
    Stage stage(f, 8, 8);
    return Stage::make(soft_shadow_volume_technique(), {})->supports(stage.the_case).value_or("");
  };
  EXPECT_EQ(refusal(), "");
  testing::add_triangle(f.geometry, {-0.2f, 0.1f, 0}, {0.2f, 0.1f, 0.1f}, {0, 0.2f, 0.3f});
  EXPECT_NE(refusal().find("closed meshes"), std::string::npos) << refusal();
}

TEST(SoftShadowVolume, FloorUnderALightBelowItIsRefused) {
  Frame f = boxes({box}, testing::rectangle_light({3, 0.2f, 0}, {0, 0.3f, 0}, 1, 1), front);
  Stage stage(f, 8, 8);
  EXPECT_TRUE(Stage::make(soft_shadow_volume_technique(), {})->supports(stage.the_case).has_value());
}

TEST(SoftShadowVolume, SpheresAreNotSplit) {
  Stage stage(boxes({box}, sphere, front), 8, 8);
  EXPECT_TRUE(Stage::make(soft_shadow_volume_technique(), {{"split", int64_t{2}}})
                  ->supports(stage.the_case)
                  .has_value());
}

TEST(SoftShadowVolume, SecondFrameAllocatesNothingAndIsTheSame) {
  Stage stage(boxes(plates, rectangle, front), width, height);
  const auto technique = stage.built(soft_shadow_volume_technique(), {{"split", int64_t{3}}});
  const Rendered first = stage.render(*technique);
  const uint64_t device = testing::device().allocated_bytes();
  stage.render_only(*technique);
  EXPECT_EQ(testing::device().allocated_bytes(), device);
  EXPECT_EQ(stage.render(*technique, false, false).visibility, first.visibility);
  EXPECT_GT(technique->structure_bytes(), 0U);
}

TEST(SoftShadowVolume, CountsEdgesWedgesAndTheirPixels) {
  Stage stage(boxes({box}, rectangle, front), width, height);
  const Rendered tight = stage.render(soft_shadow_volume_technique(), {});
  const Rendered loose = stage.render(soft_shadow_volume_technique(), {{"wedges", "loose"}});
  EXPECT_EQ(number(tight.counters, "silhouette_edges"), 6);  // of a box seen from in front of a corner
  EXPECT_EQ(number(tight.counters, "wedge_pixels"), number(loose.counters, "wedge_pixels"));
  EXPECT_GT(number(tight.counters, "wedge_pixels"), 500);
  EXPECT_LT(number(tight.counters, "wedge_fragments"), number(loose.counters, "wedge_fragments"));
}

}  // namespace
}  // namespace penumbra
