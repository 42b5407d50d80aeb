// soft_shadow_volume against closed forms in double precision: exact where its two assumptions hold, and off
// by what they say where they do not.
#include "techniques/soft_shadow_volume/soft_shadow_volume.h"

#include <functional>

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

// Visibility of the whole light, whatever its shape.
double visibility(const Light& light, Vec3d p, Vec3d n, const std::vector<Polygon>& occluders) {
  return light.kind == LightKind::sphere
             ? testing::disc_visibility(Vec3d(light.center), double(light.radius), p, n, occluders)
             : testing::rectangle_visibility(light, p, n, occluders);
}

struct Agreement {
  double worst = 0, mean = 0, signed_mean = 0;
  int umbra = 0, penumbra = 0, lit = 0, low = 0, pixels = 0;  // low: the light is partly below the horizon
};

// `truth`: visibility at a view sample.
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
    a.worst = std::max(a.worst, std::abs(error));
    a.mean += std::abs(error), a.signed_mean += error;
    a.umbra += t<1e-9, a.lit += t> 1 - 1e-9, a.penumbra += t > 0.01 && t < 0.99;
    a.low += horizon < 0.99 && horizon > 0.01;
    ++a.pixels;
  }
  a.mean /= a.pixels, a.signed_mean /= a.pixels;
  return a;
}

// Boxes one after the other hide the light; seen from any view sample their shadows must not overlap. Those
// that a view sample lies on do not: they are convex, and the horizon says it all.
Agreement against_boxes(const Stage& stage, const Rendered& r, const std::vector<Box3>& all) {
  return compare(stage, r, [&](std::size_t pixel, Vec3d p, Vec3d n) {
    const uint32_t t = stage.view.host().triangle[pixel];
    std::vector<Polygon> occluders;
    for (std::size_t b = 0; b < all.size(); ++b)
      if (t < 2 || (t - 2) / 12 != b)
        for (Polygon& face : testing::faces_towards(p, Vec3d(all[b].lo), Vec3d(all[b].hi)))
          occluders.push_back(std::move(face));
    return visibility(stage.frame.light, p, n, occluders);
  });
}

Agreement one_box(const Light& light, const Camera& camera, const ParamValues& given) {
  Stage stage(boxes({box}, light, camera), width, height);
  return against_boxes(stage, stage.render(soft_shadow_volume_technique(), given), {box});
}

void expect_exact(const Agreement& a, double tolerance = 2e-5) {
  EXPECT_LT(a.worst, tolerance);
  EXPECT_GT(a.penumbra, 100);
  EXPECT_GT(a.lit, 100);
}

TEST(SoftShadowVolume, OneConvexOccluderIsExact) {
  for (const Light& light : {rectangle, sphere}) {
    const Agreement a = one_box(light, front, {});
    expect_exact(a);
    EXPECT_GT(a.umbra, 100);
  }
}

TEST(SoftShadowVolume, LooseWedgesGiveTheSamePicture) {
  for (const Light& light : {rectangle, sphere}) expect_exact(one_box(light, front, {{"wedges", "loose"}}));
}

}  // namespace
}  // namespace penumbra
