// What sample_based_soft does beyond masks, against double precision: transparency by weighting, and the
// cosines of coherent shading.
#include <gtest/gtest.h>

#include <numeric>

#include "techniques/sample_based_soft/sample_based_soft.h"
#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"
#include "tests/support/segment.h"
#include "tests/support/stage.h"

namespace penumbra {
namespace {

using testing::Rendered;
using testing::Stage;
using testing::Triangle;

Frame boxes(int soup) {
  Frame f;
  testing::add_box(f.geometry, {-0.6F, 0.2F, -0.5F}, {-0.1F, 0.9F, 0.1F});
  testing::add_box(f.geometry, {0.1F, 0.0F, -0.3F}, {0.5F, 0.6F, 0.3F});
  if (soup > 0) testing::add_soup(f.geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, soup, 0.15F, 3);
  testing::add_ground(f.geometry, 2);
  f.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0.3F, 0}, 0.8F, 0.5F);
  f.camera = testing::camera_at({0, 1.5F, 3.5F}, {0, 0.6F, 0});
  return f;
}

Triangle triangle(const Geometry& g, std::size_t t) {
  return {Vec3d(g.corner(t, 0)), Vec3d(g.corner(t, 1)), Vec3d(g.corner(t, 2))};
}

// The share above the horizon, times what each triangle that covers some of it lets through.
double weighted(const Stage& s, std::size_t pixel, double transparency, int& above) {
  const ViewSamplesHost& view = s.view.host();
  const Vec3d origin(view.origin[pixel].xyz());
  std::vector<testing::Segment> segments;
  for (const Vec4f& l : s.light_samples.points) {
    const Vec4d point{double(l.x), double(l.y), double(l.z), 1};
    if (!testing::judge_horizon(s.frame.light, Vec3d(view.position[pixel].xyz()),
                                Vec3d(view.geometric_normal[pixel].xyz()), point)
             .blocked)
      segments.push_back({origin, point.xyz() - origin});
  }
  above = static_cast<int>(segments.size());
  double through = double(above) / s.light_samples.count();
  for (std::size_t t = 0; t < s.frame.geometry.triangle_count(); ++t) {
    const Triangle corners = triangle(s.frame.geometry, t);
    int covered = 0;
    for (const testing::Segment& segment : segments) covered += meet(segment, corners).has_value();
    if (covered > 0) through *= 1 - (1 - transparency) * covered / above;
  }
  return through;
}

void expect_weighted(const ParamValues& params, const LightSampleRequest& request, double transparency) {
  Stage s(boxes(60), 35, 27);
  s.light_samples = make_light_samples(s.frame.light, request);
  const Rendered r = s.render(*s.built(sample_based_soft_technique(), params), true, false);
  int evaluated = 0, shadowed = 0, off = 0;
  for (std::size_t pixel = 0; pixel < s.pixels(); ++pixel) {
    if (s.view.host().triangle[pixel] == no_triangle) continue;
    int above = 0;
    const double truth = weighted(s, pixel, transparency, above),
                 error = std::abs(double(r.visibility[pixel]) - truth);
    ++evaluated, shadowed += truth > 0.05 && truth < 0.95;
    if (error < 2e-5) continue;
    ++off;  // a light sample on an edge, for one triangle or for both that share it
    EXPECT_LT(error, 2.5 * (1 - transparency) / std::max(above, 1)) << "pixel " << pixel;
  }
  EXPECT_GT(shadowed, 50);
  EXPECT_LT(off, evaluated / 50 + 1);
}

TEST(Transparency, IsTheProductOfWhatEachTriangleLetsThroughByItsCoverage) {
  for (const char* regions : {"blocks", "triangles"})
    for (const LightSampleRequest& request :
         {LightSampleRequest{16, 16}, LightSampleRequest{5, 7}, LightSampleRequest{0, 0, 70}})
      expect_weighted({{"transparency", 0.4}, {"regions", std::string(regions)}}, request, 0.4);
}

TEST(Transparency, OfWorkInManyDispatchesIsTheSame) {
  expect_weighted({{"transparency", 0.7}, {"dispatch_turns", int64_t{64}}}, {16, 16}, 0.7);
}

TEST(Transparency, LeavesTheMaskAlone) {
  Stage s(boxes(60), 35, 27);
  s.light_samples = make_light_samples(s.frame.light, {16, 16});
  const auto info = sample_based_soft_technique();
  const Rendered opaque = s.render(*s.built(info, {}), true, false);
  const Rendered clear = s.render(*s.built(info, {{"transparency", 0.5}}), true, false);
  EXPECT_EQ(opaque.mask, clear.mask);
  EXPECT_GT(std::accumulate(clear.visibility.begin(), clear.visibility.end(), 0.0),
            std::accumulate(opaque.visibility.begin(), opaque.visibility.end(), 0.0) + 1);
}

TEST(Transparency, SaysWhatItCannotWeigh) {
  Stage s(boxes(0), 9, 9);
  s.light_samples = make_light_samples(s.frame.light, {0, 0, 1500});
  const auto info = sample_based_soft_technique();
  EXPECT_TRUE(Stage::make(info, {{"transparency", 0.5}})->supports(s.the_case).has_value());
  s.light_samples = make_light_samples(s.frame.light, {8, 8});
  EXPECT_FALSE(Stage::make(info, {{"transparency", 0.5}})->supports(s.the_case).has_value());
  EXPECT_TRUE(Stage::make(info, {{"transparency", 0.5}, {"restrict_to_penumbra", true}})
                  ->supports(s.the_case)
                  .has_value());
}

// The source's formula by a search over all triangles that have the corner.
double coherent(const Stage& s, std::size_t pixel, double c) {
  const ViewSamplesHost& view = s.view.host();
  const Geometry& g = s.frame.geometry;
  const std::size_t t = view.triangle[pixel];
  const Vec3d light(s.frame.light.center), seen(view.geometric_normal[pixel].xyz());
  const auto normal = [&](std::size_t f) {
    const Triangle k = triangle(g, f);
    return normalize(cross(k[1] - k[0], k[2] - k[0]));
  };
  const double side = dot(normal(t), seen) < 0 ? -1 : 1;
  double bend[3];
  for (int corner = 0; corner < 3; ++corner) {
    const Vec3f v = g.corner(t, corner);
    bend[corner] = 2;
    for (std::size_t f = 0; f < g.triangle_count(); ++f)
      for (int k = 0; k < 3; ++k)
        if (g.corner(f, k) == v)
          bend[corner] = std::min(bend[corner], side * dot(normal(f), normalize(light - Vec3d(v))));
  }
  const double u{view.barycentrics[pixel].x}, w{view.barycentrics[pixel].y};
  const double l_bend = (1 - u - w) * bend[0] + u * bend[1] + w * bend[2];
  const double l_f =
      dot(Vec3d(view.shading_normal[pixel].xyz()), normalize(light - Vec3d(view.position[pixel].xyz())));
  const double alpha = std::min(1.0, std::max(c * l_bend, 0.0));
  return std::max(alpha * l_f + (1 - alpha) * l_bend, 0.0);
}

TEST(CoherentShading, IsTheSourcesFormulaAndBlackOnBackFaces) {
  for (const double c : {3.0, 1.0}) {
    Frame knot = Scene::load("torus_knot", {"configs/scenes"}).frame(0, "", "", -1);
    Stage s(std::move(knot), 60, 50);
    s.light_samples = make_light_samples(s.frame.light, {4, 4});
    const auto technique =
        s.built(sample_based_soft_technique(), {{"coherent_shading", true}, {"bend_weight", c}});
    s.render(*technique, true, false);
    const std::vector<float> cosines = technique->cosines();
    ASSERT_EQ(cosines.size(), s.pixels());
    int smooth = 0, bent = 0, black = 0;
    for (std::size_t pixel = 0; pixel < s.pixels(); ++pixel) {
      if (s.view.host().triangle[pixel] == no_triangle) continue;
      ASSERT_NEAR(double(cosines[pixel]), coherent(s, pixel, c), 2e-4) << "pixel " << pixel;
      const Vec3f l = normalize(s.frame.light.center - s.view.host().position[pixel].xyz());
      const float phong = std::max(0.0F, dot(s.view.host().shading_normal[pixel].xyz(), l));
      const float apart = std::abs(cosines[pixel] - phong);
      if (apart < 1e-4F) ++smooth;
      if (apart > 1e-3F) ++bent;
      if (dot(s.view.host().geometric_normal[pixel].xyz(), l) < -0.2F) {
        EXPECT_EQ(cosines[pixel], 0) << "pixel " << pixel;
        ++black;
      }
    }
    // Both parts of the formula are seen; with c = 1 only what faces the light whole has alpha = 1.
    EXPECT_GT(smooth, c > 1 ? 100 : 20);
    EXPECT_GT(bent, 20);
    EXPECT_GT(black, 20);
  }
}

TEST(CoherentShading, LeavesVisibilityAsItIs) {
  Stage s(boxes(0), 35, 27);
  s.light_samples = make_light_samples(s.frame.light, {8, 8});
  const auto info = sample_based_soft_technique();
  const Rendered plain = s.render(*s.built(info, {}), true, false);
  const auto shading = s.built(info, {{"coherent_shading", true}});
  const Rendered shaded = s.render(*shading, true, false);
  EXPECT_EQ(plain.mask, shaded.mask);
  EXPECT_EQ(plain.visibility, shaded.visibility);
  EXPECT_TRUE(s.built(info, {})->cosines().empty());
}

}  // namespace
}  // namespace penumbra
