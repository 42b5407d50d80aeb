// Light samples that each pixel moves, and those that change from frame to frame: every technique that takes
// them must give the masks of the same definition, held against double precision.
#include <gtest/gtest.h>

#include <bit>

#include "techniques/registry.h"
#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"
#include "tests/support/stage.h"

namespace penumbra {
namespace {

using testing::BruteForce;
using testing::Rendered;
using testing::Stage;

// A closed box and a soup of triangles, one instance, over a ground, another: planar shadows need a flat one.
Frame scene(const Light& light) {
  Frame f;
  testing::add_ground(f.geometry, 2);
  const std::size_t ground = f.geometry.triangle_count();
  testing::add_box(f.geometry, {-0.6F, 0.2F, -0.5F}, {-0.1F, 0.9F, 0.1F});
  testing::add_soup(f.geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, 120, 0.15F, 3);
  f.geometry.triangle_instance.assign(f.geometry.triangle_count(), 1);
  std::fill_n(f.geometry.triangle_instance.begin(), ground, 0U);
  f.geometry.instance_albedo.assign(2, {0.5F, 0.5F, 0.5F});
  f.light = light;
  f.camera = testing::camera_at({0, 1.5F, 3.5F}, {0, 0.6F, 0});
  return f;
}

Light rectangle() { return testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F); }

Light sphere() {
  Light l = testing::point_light({1.5F, 3, -1});
  l.kind = LightKind::sphere;
  l.radius = 0.4F;
  return l;
}

// Renders with what the light samples are at the time, wherever the technique wants its output.
Rendered render(Stage& s, Technique& technique, const TechniqueInfo& info) {
  return info.residence == Residence::device ? s.render(technique, true, false) : s.render_on_host(technique);
}

void expect_only_ties(const Stage& s, const Rendered& r) {
  const BruteForce oracle(s.frame.geometry);
  const auto truth = testing::brute_force_mask(oracle, s.frame.light, s.light_samples, s.view.host());
  std::vector<uint8_t> seen;
  for (const uint32_t t : s.view.host().triangle) seen.push_back(t != no_triangle);
  const auto d = testing::explain_differences(oracle, s.frame.light, s.light_samples, s.view.host(), r.mask,
                                              truth, seen);
  EXPECT_EQ(d.unexplained, 0U) << d.differing << " of " << d.bits << " differ; the worst is " << d.worst
                               << " tolerances from a tie";
  EXPECT_LE(d.differing, d.bits / 2000);
  EXPECT_GT(d.bits, 0U);
}

uint64_t bits_apart(const Rendered& a, const Rendered& b) {
  uint64_t n = 0;
  for (std::size_t i = 0; i < a.mask.size(); ++i)
    n += static_cast<uint64_t>(std::popcount(a.mask[i] ^ b.mask[i]));
  return n;
}

struct Variant {
  std::string technique;
  ParamValues params;
  bool grids_only = false;
};

std::vector<Variant> rotating() {
  return {{"ray_tracing", {}},
          {"ray_tracing", {{"order", std::string("pixels")}}},
          {"sample_based_soft", {}},
          {"sample_based_soft", {{"regions", std::string("triangles")}, {"restrict_to_penumbra", true}}},
          {"gears", {}, true},
          {"gears", {{"assignment", std::string("triangles")}}, true}};
}

void expect_rotation(const Light& light, LightSampleRequest request, PixelMove move) {
  request.rotation = LightRotation::per_pixel;
  Stage s(scene(light), 41, 33);
  s.light_samples = make_light_samples(light, request);
  ASSERT_EQ(s.light_samples.move, move);
  const Registry all = all_techniques();
  for (const Variant& v : rotating()) {
    SCOPED_TRACE(v.technique);
    const TechniqueInfo& info = find_technique(all, v.technique);
    ASSERT_TRUE(info.rotates);
    if (v.grids_only && move != PixelMove::shift) {
      EXPECT_TRUE(Stage::make(info, v.params)->supports(s.the_case).has_value());
      continue;
    }
    expect_only_ties(s, render(s, *s.built(info, v.params), info));
  }
}

TEST(LightRotation, OfARegularGridIsAShiftWithinItsCells) {
  expect_rotation(rectangle(), {16, 16}, PixelMove::shift);
  expect_rotation(rectangle(), {5, 12}, PixelMove::shift);
}
TEST(LightRotation, OfOtherSetsOnARectangleWrapsAround) {
  expect_rotation(rectangle(), {0, 0, 70}, PixelMove::wrap);
  expect_rotation(rectangle(), {8, 8, 0, LightPattern::jittered}, PixelMove::wrap);
}
TEST(LightRotation, OfASphereTurnsIt) { expect_rotation(sphere(), {8, 9}, PixelMove::turn); }

// A table is made for one set; turning or shifting the planes must give what it gives for samples that are
// moved.
TEST(LightRotation, LeavesTheTableAsGoodAsItIs) {
  const Registry all = all_techniques();
  const TechniqueInfo& info = find_technique(all, "sample_based_soft");
  const ParamValues table{{"half_spaces", std::string("table")}, {"table_size", int64_t{64}}};
  for (const Light& light : {rectangle(), sphere()}) {
    double wrong[2];
    for (const LightRotation rotation : {LightRotation::none, LightRotation::per_pixel}) {
      Stage s(scene(light), 61, 49);
      LightSampleRequest request{8, 8};
      request.rotation = rotation;
      s.light_samples = make_light_samples(light, request);
      const Rendered r = s.render(*s.built(info, table), true, false);
      const MatchedReference& truth = s.reference(ReferenceOrigin::offset);
      double sum = 0;
      for (std::size_t i = 0; i < s.pixels(); ++i)
        if (truth.evaluated[i]) sum += std::abs(double(r.visibility[i]) - double(truth.visibility[i]));
      wrong[rotation == LightRotation::per_pixel] = sum / double(s.pixels());
    }
    EXPECT_LT(wrong[1], 1.5 * wrong[0]);
    EXPECT_GT(wrong[1], wrong[0] / 1.5);
  }
  Stage s(scene(rectangle()), 9, 9);
  LightSampleRequest request{0, 0, 70};
  request.rotation = LightRotation::per_pixel;
  s.light_samples = make_light_samples(s.frame.light, request);
  EXPECT_TRUE(Stage::make(info, table)->supports(s.the_case).has_value());
}

// The next set comes as a light that has changed; what was made for the last one must not stay.
TEST(LightJitter, EverySampledTechniqueTakesTheNextSet) {
  const Registry all = all_techniques();
  for (const TechniqueInfo& info : all) {
    if (!info.sampled) continue;
    SCOPED_TRACE(info.name);
    Stage s(scene(rectangle()), 41, 33);
    s.light_samples = make_light_samples(s.frame.light, {8, 8});
    ParamValues params;
    if (info.name == "line_space") params = {{"branching", int64_t{4}}, {"depth", int64_t{3}}};
    const auto technique = s.built(info, params);
    const Rendered first = render(s, *technique, info);
    LightSampleRequest next{8, 8};
    next.set = 1;
    s.light_samples = make_light_samples(s.frame.light, next);
    s.frame.changes = {false, false, true, false};
    technique->build(s.the_case, s.passes);
    s.passes.take_times();
    const Rendered stepped = render(s, *technique, info);
    EXPECT_GT(bits_apart(first, stepped), 0U);
    s.frame.changes = {};
    EXPECT_EQ(bits_apart(render(s, *s.built(info, params), info), stepped), 0U);
    if (info.name == "ray_tracing" || info.name == "gears" || info.name == "sample_based_soft" ||
        info.name == "depth_complexity_sampling")
      expect_only_ties(s, stepped);
  }
}

}  // namespace
}  // namespace penumbra
