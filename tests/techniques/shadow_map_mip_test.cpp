// Mip chains and anisotropic filtering of filterable maps.
#include "shadow_map_scenes.h"
#include "techniques/common/shadow_maps/moment_maps.h"

namespace penumbra::test {
namespace {

// A comb of slats that throws stripes `pitch` wide on the ground.
Frame comb(Vec3f eye, Vec3f target, float pitch) {
  Frame f;
  add_ground(f.geometry, 8);
  for (float x = -8; x < 8; x += 2 * pitch) add_quad(f.geometry, {x, 1, 8}, {pitch, 0, 0}, {0, 0, -16});
  f.light = directional_light({0.02f, -1, 0.01f});
  f.camera.eye = eye, f.camera.target = target, f.camera.vertical_fov_degrees = 30;
  return f;
}

ParamValues map_of(const char* filter, const char* filtering, int64_t size = 1024) {
  return {{"filter", filter},      {"moment_filtering", filtering},
          {"map_size", size},      {"filter_size", int64_t{1}},
          {"fit", "none"},         {"slope_bias", 0.0},
          {"constant_bias", 1e-3}, {"bleeding_reduction", 0.0}};
}

ParamValues tight(ParamValues given) {
  given["fit"] = "tight";
  return given;
}

// The moments of every level, as floats: level after level.
struct Chain {
  std::vector<std::vector<float>> levels;  // of `count` moments a texel
  std::size_t count = 0;
};

Chain chain_of(Stage& stage, const ParamValues& given) {
  const shadow_map::Params params = stage.params(given);
  shadow_map::Fitter fitter(params);
  shadow_map::DepthMaps maps(params);
  shadow_map::MomentMaps moments(params);
  fitter.setup(device()), maps.setup(device()), moments.setup(device());
  const shadow_map::Fitted& fitted =
      fitter.run(stage.the_case, light_point(stage.frame.light), stage.view, stage.passes);
  maps.draw(stage.the_case, fitted, stage.passes);
  moments.run(fitted, maps, stage.passes);
  std::vector<float> all(moments.moments().bytes() / sizeof(float));
  gpu::download(stage.passes, "download", moments.moments(), all.data(), all.size() * sizeof(float));
  Chain chain;
  chain.count = static_cast<std::size_t>(shadow_map::moment_bytes(params)) / sizeof(float);
  auto at = all.begin();
  for (int level = 0; level < params.moment_levels(); ++level) {
    const auto size = static_cast<std::size_t>(std::max(params.map_size >> level, 1));
    const auto end = at + static_cast<std::ptrdiff_t>(size * size * chain.count);
    chain.levels.emplace_back(at, end);
    at = end;
  }
  EXPECT_EQ(fitted.layers.size(), 1u);
  return chain;
}

TEST(ShadowMapLevels, EachTexelIsTheMeanOfTheFourBelowIt) {
  Stage stage(box_and_sphere(point_light({1, 5, 2})), 64, 48);
  const Chain c = chain_of(stage, tight(map_of("msm", "trilinear", 64)));
  ASSERT_EQ(c.levels.size(), 7u);
  for (std::size_t level = 1; level < c.levels.size(); ++level) {
    const std::size_t size = 64u >> level, finer = 2 * size;
    for (std::size_t y = 0; y < size; ++y)
      for (std::size_t x = 0; x < size; ++x)
        for (std::size_t m = 0; m < c.count; ++m) {
          double sum = 0;
          for (const std::size_t i : {0, 1})
            for (const std::size_t j : {0, 1})
              sum += double(c.levels[level - 1][((2 * y + i) * finer + 2 * x + j) * c.count + m]);
          EXPECT_NEAR(double(c.levels[level][(y * size + x) * c.count + m]), sum / 4, 1e-6);
        }
  }
}

TEST(ShadowMapLevels, KeepTheMeanOfMapsOfAnySize) {
  Stage stage(box_and_sphere(point_light({1, 5, 2})), 64, 48);
  for (const int64_t size : {100, 333, 1023}) {
    const Chain c = chain_of(stage, tight(map_of("vsm", "anisotropic", size)));
    const auto mean = [&](const std::vector<float>& level, std::size_t moment) {
      double sum = 0;
      for (std::size_t i = moment; i < level.size(); i += c.count) sum += double(level[i]);
      return sum / (double(level.size()) / double(c.count));
    };
    EXPECT_EQ(c.levels.back().size(), c.count);
    for (std::size_t m = 0; m < c.count; ++m)
      for (const std::vector<float>& level : c.levels)
        EXPECT_NEAR(mean(level, m), mean(c.levels[0], m), 2e-5) << size;
  }
}

// Where a pixel is smaller than a texel there is nothing to average.
TEST(ShadowMapLevels, MagnifiedMapsAreReadFromTheFinestLevel) {
  Stage stage(comb({0, 0.8f, 0.2f}, {0, 0, 0}, 0.5f), 127, 95);
  const Rendered bilinear = stage.render(map_of("vsm", "bilinear", 128));
  EXPECT_LT(number(bilinear.counters, "undersampled_share"), 1.01);
  EXPECT_EQ(bilinear.visibility, stage.render(map_of("vsm", "trilinear", 128)).visibility);
}

// The true share of light in a pixel: rays through 12 x 12 places in it.
std::vector<double> supersampled(const Frame& frame, int width, int height) {
  constexpr int n = 12;
  Stage fine(frame, width * n, height * n);
  std::vector<double> share(static_cast<std::size_t>(width * height));
  for (std::size_t i = 0; i < fine.pixels(); ++i) {
    const std::size_t x = i % static_cast<std::size_t>(width * n) / n,
                      y = i / static_cast<std::size_t>(width * n) / n;
    share[y * static_cast<std::size_t>(width) + x] += double(fine.reference().visibility[i]) / (n * n);
  }
  return share;
}

class EachLevelledMap : public ::testing::TestWithParam<const char*> {
 protected:
  // Over the ground alone.
  static double error(Stage& stage, const std::vector<double>& truth, const char* filtering) {
    const Rendered r = stage.render(map_of(GetParam(), filtering));
    double sum = 0, n = 0;
    for (std::size_t i = 0; i < stage.pixels(); ++i) {
      if (!stage.reference().evaluated[i] || stage.view.host().position[i].y > 0.5f) continue;
      sum += std::abs(double(r.visibility[i]) - truth[i]), n += 1;
    }
    EXPECT_GT(n, 500);
    return sum / n;
  }
};
INSTANTIATE_TEST_SUITE_P(ShadowMap, EachLevelledMap, ::testing::Values("vsm", "evsm", "msm"),
                         [](const auto& i) { return i.param; });

// Stripes narrower than a pixel: point samples of the map are right or wrong by chance, levels give the
// share.
TEST_P(EachLevelledMap, AverageWhatIsSmallerThanAPixel) {
  const Frame f = comb({0.1f, 0.9f, 14}, {0, 0, 0}, 0.05f);
  constexpr int width = 80, height = 36;
  Stage stage(f, width, height);
  const std::vector<double> truth = supersampled(f, width, height);
  const double bilinear = error(stage, truth, "bilinear"), trilinear = error(stage, truth, "trilinear"),
               anisotropic = error(stage, truth, "anisotropic");
  EXPECT_LT(anisotropic, 0.8 * bilinear);
  EXPECT_LT(anisotropic, trilinear);
}

}  // namespace
}  // namespace penumbra::test
