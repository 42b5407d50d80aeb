// Soft shadows and filterable maps against their formulas and closed forms.
#include <random>

#include "shadow_map_scenes.h"
#include "techniques/common/shadow_maps/shaders/moment_filters.h"

namespace penumbra::test {
namespace {

namespace filters = shadow_map::filters;

struct Distribution {  // of depth: weights sum to 1
  std::vector<double> depth, weight;
  double moment(int k) const {
    double m = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) m += weight[i] * std::pow(depth[i], k);
    return m;
  }
  double lit(double z) const {  // share of depths not before z
    double v = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) v += depth[i] >= z ? weight[i] : 0;
    return v;
  }
};

Distribution random_distribution(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> unit(0.05, 1);
  Distribution d;
  double sum = 0;
  for (int i = 0; i < count; ++i)
    d.depth.push_back(unit(random)), d.weight.push_back(unit(random)), sum += d.weight.back();
  for (double& w : d.weight) w /= sum;
  return d;
}

TEST(MomentFilters, ChebyshevIsItsFormulaAndBoundsTheTruth) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Distribution d = random_distribution(random, 1 + i % 6);
    const double z = std::uniform_real_distribution<double>(0, 1)(random), mu = d.moment(1),
                 var = d.moment(2) - mu * mu;
    const double v = double(filters::chebyshev(float(mu), float(d.moment(2)), float(z), 1e-5f));
    const double expected = z <= mu ? 1 : std::max(var, 1e-5) / (std::max(var, 1e-5) + (z - mu) * (z - mu));
    EXPECT_NEAR(v, expected, 2e-3);  // float cancels in the variance
    EXPECT_GE(v, d.lit(z) - 2e-3);
  }
}

// Independent of the shader's elimination: the extremal distribution has `depth` and the roots of the kernel
// polynomial as its support; solved here by bisection-free closed forms in long double.
double msm_by_support(const Distribution& d, long double z) {
  const long double b1 = d.moment(1), b2 = d.moment(2), b3 = d.moment(3), b4 = d.moment(4);
  // c = B^-1 (1, z, z^2) by Cramer's rule.
  const auto det = [](long double a, long double b, long double c, long double e, long double f,
                      long double g, long double h, long double i, long double j) {
    return a * (f * j - g * i) - b * (e * j - g * h) + c * (e * i - f * h);
  };
  const long double zz = z * z;
  const long double c1 = det(1, b1, b2, z, b2, b3, zz, b3, b4);
  const long double c2 = det(1, 1, b2, b1, z, b3, b2, zz, b4);
  const long double c3 = det(1, b1, 1, b1, b2, z, b2, b3, zz);
  const long double p = c2 / c3, q = c1 / c3, r = std::sqrt(std::max(p * p / 4 - q, 0.0L));
  const long double z1 = -p / 2 - r, z2 = -p / 2 + r;
  // Weights of z, z1, z2 that have the moments 1, b1, b2.
  const long double denominator_z = (z - z1) * (z - z2), denominator_1 = (z1 - z) * (z1 - z2);
  const long double wz = (b2 - b1 * (z1 + z2) + z1 * z2) / denominator_z;
  const long double w1 = (b2 - b1 * (z + z2) + z * z2) / denominator_1;
  // Least shadow: the weight strictly before z.
  if (z <= z1) return 1;
  if (z <= z2) return double(1 - w1);
  return double(wz);
}

TEST(MomentFilters, FourMomentsAreTheExtremalDistributionsAndBoundTheTruth) {
  std::mt19937 random(2);
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const Distribution d = random_distribution(random, 4 + i % 4);
    const double z = std::uniform_real_distribution<double>(0.02, 1)(random);
    const double v = double(filters::four_moments(float(d.moment(1)), float(d.moment(2)), float(d.moment(3)),
                                                  float(d.moment(4)), float(z), 0));
    EXPECT_GE(v, d.lit(z) - 0.03);
    const double mu = d.moment(1), var = d.moment(2) - mu * mu;
    if (var < 0.01) continue;  // float's cancellation
    ++compared;
    EXPECT_NEAR(v, msm_by_support(d, z), 0.03) << i;
  }
  EXPECT_GT(compared, 1500);
}

// Two depths are what four moments recover exactly.
TEST(MomentFilters, FourMomentsRecoverTwoDepths) {
  for (double f : {0.1, 0.35, 0.8}) {
    const Distribution d{{0.3, 0.7}, {f, 1 - f}};
    const auto at = [&](double z) {
      return double(filters::four_moments(float(d.moment(1)), float(d.moment(2)), float(d.moment(3)),
                                          float(d.moment(4)), float(z), 3e-7f));
    };
    EXPECT_NEAR(at(0.2), 1, 0.02);
    EXPECT_NEAR(at(0.68), 1 - f, 0.05);
    EXPECT_NEAR(at(0.9), 0, 0.05);
  }
}

TEST(MomentFilters, BleedingReductionStretches) {
  EXPECT_EQ(filters::reduce_bleeding(0.15f, 0.2f), 0);
  EXPECT_FLOAT_EQ(filters::reduce_bleeding(0.6f, 0.2f), 0.5f);
  EXPECT_EQ(filters::reduce_bleeding(1, 0.2f), 1);
}

// A half-plane at height `h` over the ground, x < 0 covered.
Frame half_plane(const Light& light, float h = 1) {
  Frame f;
  add_ground(f.geometry, 2);
  add_quad(f.geometry, {-2, h, 2}, {2, 0, 0}, {0, 0, -4});
  f.light = light;
  f.camera.eye = {0.1f, 0.5f * h, 1.2f}, f.camera.target = {0.1f, 0, 0}, f.camera.vertical_fov_degrees = 40;
  return f;
}

class EachMomentMap : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(ShadowMap, EachMomentMap, ::testing::Values("vsm", "evsm", "msm"),
                         [](const auto& i) { return i.param; });

// Under one edge a map holds two depths, of which all three bounds give the exact share: the ramp of a box
// filter, widened by the interpolation between texels.
TEST_P(EachMomentMap, HalfPlaneThrowsTheBoxFiltersRamp) {
  Stage stage(half_plane(directional_light({0, -1, 0})), 127, 63);
  constexpr int size = 64, taps = 9;
  const Rendered r = stage.render({{"filter", GetParam()},
                                   {"filter_size", int64_t{taps}},
                                   {"map_size", int64_t{size}},
                                   {"fit", "none"},
                                   {"bleeding_reduction", 0.0},
                                   {"slope_bias", 0.0},
                                   {"constant_bias", 0.0},
                                   {"min_variance", 1e-7}});
  const double texel = 4 / (size - 2 * (0.5 * (taps + 1) + 1));
  int ramp = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    const Vec4f p = stage.view.host().position[i];
    if (!stage.reference().evaluated[i] || p.y > 0.4f || p.x < -1 || std::abs(p.z) > 1) continue;
    const double expected = std::clamp(0.5 + double(p.x) / (taps * texel), 0.0, 1.0);
    EXPECT_NEAR(double(r.visibility[i]), expected, 1.001 / taps) << p.x;
    ramp += expected > 0.1 && expected < 0.9;
  }
  EXPECT_GT(ramp, 100);
}

TEST_P(EachMomentMap, SixteenBitsAreNearThirtyTwo) {
  Stage stage(box_and_sphere(point_light({1, 5, 2})), 101, 77);
  ParamValues given{{"filter", GetParam()}, {"map_size", int64_t{512}}, {"evsm_positive", 5.0},
                    {"evsm_negative", 5.0}, {"moment_bias", 3e-5},      {"min_variance", 1e-4}};
  const Rendered full = stage.render(given);
  given["moment_format"] = "bits16";
  const Rendered half = stage.render(given);
  EXPECT_LT(stage.error(full.visibility, half.visibility), 0.02);
  EXPECT_LT(number(half.counters, "map_bytes"), number(full.counters, "map_bytes"));
}

TEST_P(EachMomentMap, ConvergesToTheHardShadow) {
  for (const Light& light :
       {point_light({1, 5, 2}), point_light({0, 1.5f, 0.9f}), directional_light({-0.3f, -1, -0.4f})}) {
    Stage stage(box_and_sphere(light), 101, 77);
    double before = 1;
    for (int64_t size : {64, 256, 1024}) {
      const double e = stage.error(
          stage.render({{"filter", GetParam()}, {"map_size", size}, {"filter_size", int64_t{3}}}));
      EXPECT_LT(e, before);
      before = e;
    }
    EXPECT_LT(before, 0.02);
  }
}

TEST_P(EachMomentMap, GaussianBlurIsNarrowerThanItsBox) {
  Stage stage(half_plane(directional_light({0, -1, 0})), 127, 63);
  const auto partial = [&](const char* blur) {
    const Rendered r = stage.render({{"filter", GetParam()},
                                     {"filter_size", int64_t{15}},
                                     {"map_size", int64_t{64}},
                                     {"bleeding_reduction", 0.0},
                                     {"blur", blur},
                                     {"slope_bias", 0.0}});
    int count = 0;
    for (std::size_t i = 0; i < stage.pixels(); ++i)
      count += r.visibility[i] > 0.05f && r.visibility[i] < 0.95f;
    return count;
  };
  EXPECT_LT(partial("gaussian"), partial("box"));
  EXPECT_GT(partial("gaussian"), 50);
}

// A lit plane has next to no variance: what rounding leaves of it must not show as noise.
TEST_P(EachMomentMap, LitGroundStaysLit) {
  for (const Light& light : {rectangle_light({1, 5, 1}, 1, 0.7f), directional_light({-0.6f, -1, -0.4f})}) {
    Frame f;
    add_ground(f.geometry, 4);
    add_box(f.geometry, {-3.9f, 0.25f, -3.9f}, {-3.5f, 1.5f, -3.5f});
    f.light = light;
    f.camera.eye = {0.5f, 3.5f, 6}, f.camera.target = {0.5f, 0, 0.5f};
    Stage stage(std::move(f), 127, 95);
    const Rendered r = stage.render({{"filter", GetParam()},
                                     {"map_size", int64_t{512}},
                                     {"filter_size", int64_t{9}},
                                     {"slope_bias", 1.0}});
    for (std::size_t i = 0; i < stage.pixels(); ++i) {
      const Vec4f p = stage.view.host().position[i];
      if (!stage.reference().evaluated[i] || p.x < -2 || p.z < -2) continue;
      EXPECT_GT(r.visibility[i], 0.95f) << p.x << " " << p.z;
    }
  }
}

// Two sheets over the ground: under the lower one, where the upper one ends, variance maps let light in.
TEST(ShadowMap, BleedingOfVarianceMapsIsSeenAndReduced) {
  Frame f = half_plane(directional_light({0, -1, 0}), 0.3f);
  add_quad(f.geometry, {-2, 3, 2}, {1.6f, 0, 0}, {0, 0, -4});  // ends at x = -0.4
  f.camera.eye = {0.1f, 0.2f, 1.6f}, f.camera.target = {-0.3f, 0, 0};
  Stage stage(std::move(f), 127, 63);
  const auto leak = [&](const ParamValues& more) {
    // A depth range that holds both sheets' true depths: fit none does not clamp casters.
    ParamValues v{{"map_size", int64_t{128}},
                  {"filter_size", int64_t{15}},
                  {"bleeding_reduction", 0.0},
                  {"fit", "none"},
                  {"slope_bias", 0.0}};
    for (const auto& m : more) v[m.first] = m.second;
    const Rendered r = stage.render(v);
    double worst = 0;
    for (std::size_t i = 0; i < stage.pixels(); ++i) {
      const Vec4f p = stage.view.host().position[i];
      if (stage.reference().evaluated[i] && p.y < 0.1f && p.x < -0.3f && p.x > -1 && std::abs(p.z) < 1)
        worst = std::max(worst, double(r.visibility[i]));
    }
    return worst;
  };
  const double vsm = leak({{"filter", "vsm"}});
  EXPECT_GT(vsm, 0.1);
  EXPECT_LT(leak({{"filter", "vsm"}, {"bleeding_reduction", 0.5}}), 0.5 * vsm);
  EXPECT_LT(leak({{"filter", "evsm"}}), 0.3 * vsm);
  EXPECT_LT(leak({{"filter", "msm"}}), 0.5 * vsm);
  EXPECT_EQ(leak({{"filter", "pcf"}}), 0);
}

// The width of the penumbra behind a half-plane is the light's, times (receiver - blocker) / blocker.
TEST(ShadowMap, SoftShadowOfAHalfPlaneIsAsWideAsItsPenumbra) {
  constexpr double height = 4, h = 1, w = 0.6;
  Stage stage(half_plane(rectangle_light({0, float(height), 0}, float(w), 0.4f), float(h)), 127, 63);
  const Rendered r = stage.render({{"filter", "pcss"},
                                   {"map_size", int64_t{1024}},
                                   {"pcf_kernel", int64_t{16}},
                                   {"pcss_search", int64_t{16}},
                                   {"slope_bias", 0.0},
                                   {"constant_bias", 1e-3},
                                   {"receiver_plane_bias", true}});
  const double penumbra = w * h / (height - h);
  int partial = 0;
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    const Vec4f p = stage.view.host().position[i];
    if (!stage.reference().evaluated[i] || p.y > 0.4f || std::abs(p.z) > 1) continue;
    // Seen from p the edge x = 0 at height h cuts the light at -x (height - h) / h: linear over the penumbra.
    EXPECT_NEAR(double(r.visibility[i]), std::clamp(0.5 + double(p.x) / penumbra, 0.0, 1.0), 0.1) << p.x;
    partial += r.visibility[i] > 0.1f && r.visibility[i] < 0.9f;
  }
  EXPECT_GT(partial, 100);
}

// On the ground, whose plane is known exactly; walls at a grazing angle are a failure that README.md
// describes.
TEST(ShadowMap, SoftShadowsAreNearerTheConvergedTruthThanHardOnes) {
  for (const bool sphere : {false, true}) {
    Light light = rectangle_light({1, 5, 1}, 1, 0.7f);
    if (sphere) light.kind = LightKind::sphere, light.radius = 0.5f;
    Frame f;
    add_ground(f.geometry, 4);
    add_quad(f.geometry, {-1.5f, 1, 0.5f}, {1, 0, 0}, {0, 0, -1});
    add_quad(f.geometry, {0.5f, 0.4f, 0.5f}, {1, 0, 0}, {0, 0, -1});
    f.light = light;
    f.camera.eye = {0.5f, 3.5f, 6}, f.camera.target = {0, 0.2f, 0};
    Stage stage(std::move(f), 101, 77);
    const ReferenceScene scene(stage.frame.geometry);
    const std::vector<float> truth =
        scene.converged(stage.view.host(), light, 512, 1, ReferenceOrigin::offset, {}).visibility;
    for (const char* pattern : {"grid", "poisson"}) {
      const auto error = [&](const char* filter) {
        const ParamValues given{
            {"filter", filter},       {"pcf_kernel", int64_t{9}},       {"map_size", int64_t{1024}},
            {"pcf_pattern", pattern}, {"poisson_samples", int64_t{64}}, {"receiver_plane_bias", true},
            {"slope_bias", 1.0}};
        const Rendered r = stage.render(given);
        double sum = 0, n = 0;
        for (std::size_t i = 0; i < stage.pixels(); ++i) {
          if (!stage.reference().evaluated[i] || stage.view.host().position[i].y > 1e-3f) continue;
          sum += std::abs(double(r.visibility[i] - truth[i])), n += 1;
        }
        return sum / n;
      };
      EXPECT_LT(error("pcss"), 0.6 * error("pcf")) << sphere << pattern;
    }
  }
}

TEST(ShadowMap, SoftShadowHardensAtContact) {
  constexpr float h = 0.02f;
  Frame f = half_plane(rectangle_light({0, 4, 0}, 0.6f, 0.6f), h);
  f.camera.eye = {1, 0.6f, 0.1f}, f.camera.target = {0, 0, 0};
  Stage stage(std::move(f), 127, 63);
  const Rendered r = stage.render({{"filter", "pcss"},
                                   {"map_size", int64_t{2048}},
                                   {"pcf_kernel", int64_t{8}},
                                   {"slope_bias", 0.0},
                                   {"constant_bias", 1e-4}});
  for (std::size_t i = 0; i < stage.pixels(); ++i) {
    const Vec4f p = stage.view.host().position[i];
    if (!stage.reference().evaluated[i] || p.y > 0.01f || std::abs(p.x) < 0.02f) continue;
    EXPECT_EQ(r.visibility[i], p.x > 0 ? 1 : 0) << p.x;
  }
}

}  // namespace
}  // namespace penumbra::test
