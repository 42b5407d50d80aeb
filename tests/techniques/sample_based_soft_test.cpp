// sample_based_soft against double precision on small scenes: with exact half-spaces every bit that differs
// must be a tie, whatever the light, the samples, the lists and the switches.
#include "techniques/sample_based_soft/sample_based_soft.h"

#include <gtest/gtest.h>

#include <bit>
#include <numeric>

#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"
#include "tests/support/stage.h"

namespace penumbra {
namespace {

using testing::BruteForce;
using testing::Rendered;
using testing::Stage;

// Ground, a soup of triangles over it, sky behind.
Frame soup(int count = 150, float size = 0.15F, uint32_t seed = 3) {
  Frame f;
  testing::add_ground(f.geometry, 2);
  testing::add_soup(f.geometry, {-0.8F, 0.1F, -0.8F}, {0.8F, 1, 0.8F}, count, size, seed);
  f.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F);
  f.camera = testing::camera_at({0, 1.5F, 3.5F}, {0, 0.6F, 0});
  return f;
}

// Closed boxes over the ground: what back faces and silhouettes need.
Frame boxes() {
  Frame f;
  testing::add_box(f.geometry, {-0.6F, 0.2F, -0.5F}, {-0.1F, 0.9F, 0.1F});
  testing::add_box(f.geometry, {0.1F, 0.0F, -0.3F}, {0.5F, 0.6F, 0.3F});
  testing::add_box(f.geometry, {-0.3F, 1.0F, -0.2F}, {0.3F, 1.1F, 0.4F});
  const std::size_t closed = f.geometry.triangle_count();
  testing::add_ground(f.geometry, 2);
  f.geometry.triangle_instance.assign(f.geometry.triangle_count(), 1);
  std::fill_n(f.geometry.triangle_instance.begin(), closed, 0U);
  f.geometry.instance_closed = {1, 0};
  f.light = testing::rectangle_light({1.5F, 3, -1}, {0, 0.3F, 0}, 0.8F, 0.5F);
  f.camera = testing::camera_at({0, 1.5F, 3.5F}, {0, 0.6F, 0});
  return f;
}

Light ball(Vec3f center, float radius) {
  Light l = testing::point_light(center);
  l.kind = LightKind::sphere;
  l.radius = radius;
  return l;
}

Light cloud(Vec3f center) {
  Light l = testing::point_light(center);
  l.kind = LightKind::volume;
  for (int i = 0; i < 70; ++i) {
    const float a = 0.7F * static_cast<float>(i);
    l.points.push_back(center +
                       Vec3f{0.5F * std::sin(a), 0.15F * std::cos(1.3F * a), 0.3F * std::sin(2.1F * a)});
    l.weights.push_back(1 + 0.5F * std::sin(a));
  }
  return l;
}

Light textured() {
  Light l = testing::rectangle_light({1.5F, 3, -1}, {0, 0, 0}, 0.8F, 0.5F);
  l.kind = LightKind::textured_rectangle;
  l.texture_width = 3, l.texture_height = 2;
  l.weights = {1, 0.2F, 0, 0.5F, 2, 1};
  return l;
}

struct Picture {
  Stage stage;
  Picture(Frame f, int width, int height, const LightSampleRequest& request)
      : stage(std::move(f), width, height) {
    stage.light_samples = make_light_samples(stage.frame.light, request);
  }
  // Counting takes pipelines of its own.
  Rendered render(const ParamValues& params, bool counted = false) {
    return stage.render(*stage.built(sample_based_soft_technique(), params), true, counted);
  }
  std::vector<uint8_t> with_view_sample() const {
    std::vector<uint8_t> evaluated;
    for (const uint32_t t : stage.view.host().triangle) evaluated.push_back(t != no_triangle);
    return evaluated;
  }
  void expect_only_ties(const Rendered& r) {
    const BruteForce oracle(stage.frame.geometry);
    const auto truth =
        testing::brute_force_mask(oracle, stage.frame.light, stage.light_samples, stage.view.host());
    const auto d = testing::explain_differences(oracle, stage.frame.light, stage.light_samples,
                                                stage.view.host(), r.mask, truth, with_view_sample());
    EXPECT_EQ(d.unexplained, 0U) << d.differing << " of " << d.bits << " differ; the worst is " << d.worst
                                 << " tolerances from a tie";
    EXPECT_LE(d.differing, d.bits / 2000);
    EXPECT_GT(std::accumulate(truth.begin(), truth.end(), uint64_t{0}), 0U) << "the scene shows no shadow";
    expect_consistent(r);
  }
  // Visibility is the weight of the clear bits, and no bit past the last light sample is set.
  void expect_consistent(const Rendered& r) const {
    const LightSamples& s = stage.light_samples;
    const std::size_t words = static_cast<std::size_t>(s.mask_words());
    for (std::size_t pixel = 0; pixel < r.visibility.size(); ++pixel) {
      if (stage.view.host().triangle[pixel] == no_triangle) continue;
      float seen = 0;
      for (std::size_t i = 0; i < s.points.size(); ++i)
        if ((r.mask[pixel * words + i / 32] >> (i % 32) & 1U) == 0) seen += s.weights[i];
      ASSERT_NEAR(r.visibility[pixel], seen, 2e-5) << pixel;
      if (s.count() % 32 != 0) {
        ASSERT_EQ(r.mask[(pixel + 1) * words - 1] >> (s.count() % 32), 0U) << pixel;
      }
    }
  }
  // Bits of view samples that are not alike.
  uint64_t differing(const Rendered& a, const Rendered& b) const {
    const std::size_t words = stage.mask_words();
    uint64_t n = 0;
    for (std::size_t i = 0; i < a.mask.size(); ++i)
      if (stage.view.host().triangle[i / words] != no_triangle)
        n += static_cast<uint64_t>(std::popcount(a.mask[i] ^ b.mask[i]));
    return n;
  }
};

const std::string both_regions[] = {"blocks", "triangles"};

class SampleBasedSoft : public ::testing::TestWithParam<std::string> {
 protected:
  ParamValues with(ParamValues more = {}) const {
    more["regions"] = GetParam();
    return more;
  }
};
INSTANTIATE_TEST_SUITE_P(Each, SampleBasedSoft, ::testing::ValuesIn(both_regions));

TEST_P(SampleBasedSoft, DiffersFromDoublePrecisionInTiesOnly) {
  Picture p(soup(), 45, 35, {16, 16});
  p.expect_only_ties(p.render(with()));
}

TEST_P(SampleBasedSoft, TakesMasksOfAnySize) {
  const std::pair<int, int> sizes[] = {{1, 1}, {1, 3}, {5, 7}, {16, 8}, {33, 2}, {64, 3}, {32, 32}, {70, 20}};
  for (const auto& [w, h] : sizes) {
    SCOPED_TRACE(std::to_string(w) + " x " + std::to_string(h));
    Picture p(soup(), 23, 17, {w, h});
    p.expect_only_ties(p.render(with()));
  }
}

TEST_P(SampleBasedSoft, TakesAnyCountAndPatternOfLightSamples) {
  for (const int n : {1, 12, 90, 1500})
    for (const LightPattern pattern : {LightPattern::regular, LightPattern::jittered, LightPattern::halton}) {
      SCOPED_TRACE(std::to_string(n) + " samples, pattern " + std::to_string(static_cast<int>(pattern)));
      Picture p(soup(), 19, 15, {0, 0, n, pattern, 5});
      p.expect_only_ties(p.render(with()));
    }
}

TEST_P(SampleBasedSoft, TakesEveryKindOfLight) {
  Light spot = testing::spot_light({1.5F, 3, -1}, {0, 0, 0}, 14);
  const std::pair<const char*, Light> lights[] = {{"point", testing::point_light({1.5F, 3, -1})},
                                                  {"spot", spot},
                                                  {"sphere", ball({1.5F, 3, -1}, 0.4F)},
                                                  {"sphere within", ball({0.1F, 0.5F, 0.1F}, 0.2F)},
                                                  {"volume", cloud({1.5F, 3, -1})},
                                                  {"volume within", cloud({0.1F, 0.6F, 0.1F})},
                                                  {"textured rectangle", textured()}};
  for (const auto& [name, light] : lights) {
    SCOPED_TRACE(name);
    Frame f = soup();
    f.light = light;
    Picture p(std::move(f), 31, 25, {8, 8});
    p.expect_only_ties(p.render(with()));
  }
}

TEST_P(SampleBasedSoft, IsTheSameWithEachSwitchOnOrOff) {
  const std::pair<const char*, Light> lights[] = {{"rectangle", boxes().light},
                                                  {"sphere", ball({1.5F, 3, -1}, 0.4F)}};
  for (const auto& [kind, light] : lights) {
    Frame f = boxes();
    f.light = light;
    Picture p(std::move(f), 61, 47, {8, 8});
    const Rendered usual = p.render(with(), true);
    p.expect_only_ties(usual);
    for (const std::string name :
         {"fit", "skip_empty_lists", "restrict_to_penumbra", "cull_back_faces", "cull_supporting_planes"})
      for (const bool on : {false, true}) {
        SCOPED_TRACE(std::string(kind) + ", " + name + (on ? " on" : " off"));
        const Rendered r = p.render(with({{name, on}}), true);
        EXPECT_LE(p.differing(r, usual), 2U);
        p.expect_only_ties(r);
        if (name == "restrict_to_penumbra" && on) {
          EXPECT_GT(testing::number(r.counters, "groups_outside_penumbrae"), 0);
          EXPECT_LT(testing::number(r.counters, "groups_outside_penumbrae"),
                    testing::number(r.counters, "groups"));
        }
        if (name == "cull_back_faces" && !on) {
          EXPECT_GT(testing::number(r.counters, "triangles_casting"),
                    testing::number(usual.counters, "triangles_casting"));
        }
      }
    const Rendered far = p.render(with({{"far_plane", std::string("scene")}}));
    EXPECT_EQ(p.differing(far, usual), 0U);
  }
}

TEST_P(SampleBasedSoft, IsTheSameWithListsOfAnyResolution) {
  Picture p(soup(), 45, 35, {16, 16});
  const Rendered usual = p.render(with());
  for (const int64_t grid : {1, 7, 33, 200, 1024}) {
    SCOPED_TRACE(grid);
    EXPECT_EQ(p.differing(p.render(with({{"grid_size", grid}})), usual), 0U);
  }
}

TEST_P(SampleBasedSoft, GoesOnWhereADispatchOrTheBudgetEnds) {
  Picture p(soup(3000, 0.2F), 45, 35, {16, 16});
  const Rendered usual = p.render(with());
  const Rendered turns = p.render(with({{"dispatch_turns", int64_t{64}}}), true);
  EXPECT_GT(testing::number(turns.counters, "walk_dispatches"), 2);
  EXPECT_EQ(p.differing(turns, usual), 0U);
  Picture many(soup(10000, 0.3F), 90, 70, {4, 4});
  const int64_t grid = 512;
  const Rendered whole = many.render(with({{"grid_size", grid}}));
  const Rendered parts = many.render(with({{"grid_size", grid}, {"list_budget_mib", int64_t{1}}}), true);
  EXPECT_EQ(many.differing(whole, parts), 0U);
  if (GetParam() == "triangles") {
    EXPECT_GT(testing::number(parts.counters, "chunks"), 1);
  }
}

}  // namespace
}  // namespace penumbra
