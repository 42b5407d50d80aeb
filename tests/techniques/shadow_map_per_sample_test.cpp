// Conventional shadow maps, one per light sample, against Embree at the same samples.
#include "techniques/shadow_map_per_sample/shadow_map_per_sample.h"

#include <bit>

#include "shadow_map_scenes.h"
#include "tests/support/stage.h"

namespace penumbra::test {
namespace {

constexpr int width = 121, height = 83;  // odd and not square

std::unique_ptr<testing::Stage> stage_of(const Light& light, LightSampleRequest request) {
  auto stage = std::make_unique<testing::Stage>(box_and_sphere(light), width, height);
  stage->light_samples = make_light_samples(light, request);
  return stage;
}

testing::Rendered render(testing::Stage& stage, ParamValues given) {
  given.emplace("constant_bias", 2e-5);
  return stage.render(shadow_map_per_sample_technique(), given);
}

double error(testing::Stage& stage, const testing::Rendered& r) {
  const MatchedReference& truth = stage.reference(ReferenceOrigin::offset);
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i)
    if (truth.evaluated[i]) sum += std::abs(double(r.visibility[i]) - double(truth.visibility[i])), n += 1;
  return sum / n;
}

double mask_mismatch(testing::Stage& stage, const testing::Rendered& r) {
  const MatchedReference& truth = stage.reference(ReferenceOrigin::offset);
  double off = 0, bits = 0;
  for (std::size_t i = 0; i < r.mask.size(); ++i) {
    if (!truth.evaluated[i / stage.mask_words()]) continue;
    off += std::popcount(r.mask[i] ^ truth.mask[i]), bits += 1;
  }
  return off / (bits / double(stage.mask_words()) * stage.light_samples.count());
}

Light ball(Vec3f center, float radius) {
  Light l;
  l.kind = LightKind::sphere, l.center = center, l.radius = radius;
  return l;
}

TEST(ShadowMapPerSample, MasksNearEmbreesAsMapsGrow) {
  for (const Light& light : {rectangle_light({1, 5, 1}, 1.4f, 0.9f), ball({1, 5, 2}, 0.6f)}) {
    const auto stage = stage_of(light, {7, 5});  // masks of two words
    double before = 1;
    for (const int64_t size : {64, 256, 1024}) {
      const testing::Rendered r = render(*stage, {{"map_size", size}});
      const double off = mask_mismatch(*stage, r);
      EXPECT_LT(off, 0.6 * before) << size;
      before = off;
    }
    EXPECT_LT(before, 0.003);
  }
}

// Unfiltered maps: each bit is one comparison, visibility their share.
TEST(ShadowMapPerSample, VisibilityIsTheShareOfClearBits) {
  const auto stage = stage_of(rectangle_light({1, 5, 1}, 1.4f, 0.9f), {6, 6});
  const testing::Rendered r = render(*stage, {{"map_size", int64_t{256}}});
  int partial = 0;
  for (std::size_t i = 0; i < stage->pixels(); ++i) {
    const int blocked = std::popcount(r.mask[2 * i]) + std::popcount(r.mask[2 * i + 1]);
    EXPECT_NEAR(r.visibility[i], 1 - float(blocked) / 36, 1e-5f);
    EXPECT_EQ(r.mask[2 * i + 1] >> 4, 0u) << "bits past the count";
    partial += blocked > 0 && blocked < 36;
  }
  EXPECT_GT(partial, 300);
}

// One sample, and it is shadow_map.
TEST(ShadowMapPerSample, OneSampleGivesTheShadowMap) {
  for (const Light& light : {point_light({1, 5, 2}), point_light({0, 1.5f, 0.9f}),
                             directional_light({-0.3f, -1, -0.4f}), spot_light({1, 5, 2}, {0, 0, 0}, 35)}) {
    const auto stage = stage_of(light, {1, 1});
    const ParamValues given{
        {"map_size", int64_t{512}}, {"constant_bias", 2e-5}, {"slope_bias", 1.5}, {"pcf_kernel", int64_t{1}}};
    const testing::Rendered many = render(*stage, given), one = stage->render(shadow_map_technique(), given);
    EXPECT_EQ(many.visibility, one.visibility);
  }
}

TEST(ShadowMapPerSample, SecondFrameAllocatesNothingAndIsTheSame) {
  const auto stage = stage_of(rectangle_light({1, 5, 1}, 1.4f, 0.9f), {3, 3});
  const auto technique = stage->built(shadow_map_per_sample_technique(), {{"map_size", int64_t{256}}});
  const testing::Rendered first = stage->render(*technique, true);
  const uint64_t bytes = testing::device().allocated_bytes();
  const testing::Rendered second = stage->render(*technique, true);
  EXPECT_EQ(testing::device().allocated_bytes(), bytes);
  EXPECT_EQ(first.mask, second.mask);
  EXPECT_LT(error(*stage, second), 0.02);
}

TEST(ShadowMapPerSample, TakesNoSoftShadowsOfOneMap) {
  const auto stage = stage_of(rectangle_light({1, 5, 1}, 1, 1), {2, 2});
  const auto technique = testing::Stage::make(shadow_map_per_sample_technique(), {{"filter", "pcss"}});
  EXPECT_NE(technique->supports(stage->the_case).value_or("").find("a point of it"), std::string::npos);
}

}  // namespace
}  // namespace penumbra::test
