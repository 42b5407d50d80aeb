#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "core/parallel.h"
#include "metrics/metrics.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

// [Wang 2004, eq. 13], pixel by pixel over all 121 weights, with two passes (means first, then moments about
// them) so that nothing cancels.
double direct_ssim(const std::vector<float>& x, const std::vector<float>& y,
                   const std::vector<uint8_t>& evaluated, int w, int h) {
  const auto counts = [&](int u, int v) {
    return u >= 0 && v >= 0 && u < w && v < h &&
           (evaluated.empty() || evaluated[static_cast<std::size_t>(v * w + u)]);
  };
  double total = 0;
  int pixels = 0;
  for (int py = 0; py < h; ++py)
    for (int px = 0; px < w; ++px) {
      if (!counts(px, py)) continue;
      double weight = 0, mx = 0, my = 0, vx = 0, vy = 0, cov = 0;
      for (int pass = 0; pass < 2; ++pass) {
        for (int dy = -5; dy <= 5; ++dy)
          for (int dx = -5; dx <= 5; ++dx) {
            if (!counts(px + dx, py + dy)) continue;
            const std::size_t i = static_cast<std::size_t>((py + dy) * w + px + dx);
            const double g = std::exp(-(dx * dx + dy * dy) / 4.5), a = double(x[i]), b = double(y[i]);
            if (pass == 0)
              weight += g, mx += g * a, my += g * b;
            else
              vx += g * (a - mx) * (a - mx), vy += g * (b - my) * (b - my), cov += g * (a - mx) * (b - my);
          }
        if (pass == 0)
          mx /= weight, my /= weight;
        else
          vx /= weight, vy /= weight, cov /= weight;
      }
      total += (2 * mx * my + 1e-4) * (2 * cov + 9e-4) / ((mx * mx + my * my + 1e-4) * (vx + vy + 9e-4));
      ++pixels;
    }
  return total / pixels;
}

std::vector<float> noise(int n, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<float> v(static_cast<std::size_t>(n));
  for (float& f : v) f = uniform(random);
  return v;
}

TEST(Ssim, EqualImagesGiveExactlyOne) {
  const std::vector<float> a = noise(37 * 23, 1);
  EXPECT_EQ(ssim({37, 23, a, {}}, {37, 23, a, {}}), 1.0);
  const std::vector<float> flat(37 * 23, 0.3f);
  EXPECT_EQ(ssim({37, 23, flat, {}}, {37, 23, flat, {}}), 1.0);
}

TEST(Ssim, ConstantImagesReduceToTheLuminanceTerm) {
  const std::vector<float> a(20 * 20, 0.25f), b(20 * 20, 0.75f);
  const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.0625 + 0.5625 + 1e-4);
  EXPECT_NEAR(ssim({20, 20, a, {}}, {20, 20, b, {}}).value(), expected, 1e-12);
  const std::vector<float> black(20 * 20, 0.0f), white(20 * 20, 1.0f);
  EXPECT_NEAR(ssim({20, 20, black, {}}, {20, 20, white, {}}).value(), 1e-4 / (1 + 1e-4), 1e-12);
}

TEST(Ssim, OnePixelIsItsOwnWindow) {
  const std::vector<float> a = {0.5f}, b = {0.25f};
  EXPECT_NEAR(ssim({1, 1, a, {}}, {1, 1, b, {}}).value(), (0.25 + 1e-4) / (0.3125 + 1e-4), 1e-15);
}

TEST(Ssim, ANegativeHasNegativeSimilarity) {
  std::vector<float> a = noise(32 * 32, 2), b;
  for (float v : a) b.push_back(1 - v);
  EXPECT_LT(ssim({32, 32, a, {}}, {32, 32, b, {}}).value(), -0.8);
}

TEST(Ssim, AgreesWithTheDirectSumAtAnySize) {
  for (const auto& [w, h] : {std::pair(1, 7), std::pair(5, 3), std::pair(11, 11), std::pair(64, 1),
                             std::pair(50, 70), std::pair(33, 131)}) {
    const std::vector<float> a = noise(w * h, 3), b = noise(w * h, 4);
    EXPECT_NEAR(ssim({w, h, a, {}}, {w, h, b, {}}).value(), direct_ssim(a, b, {}, w, h), 1e-12)
        << w << " x " << h;
  }
}

TEST(Ssim, AgreesWithTheDirectSumWherePixelsAreNotEvaluated) {
  const int w = 61, h = 47;
  std::vector<float> a = noise(w * h, 5), b = noise(w * h, 6);
  std::vector<uint8_t> evaluated(a.size());
  std::mt19937 random(7);
  for (std::size_t i = 0; i < a.size(); ++i)
    evaluated[i] = i > a.size() / 2 ? random() % 3 == 0 : i % 61 < 20;
  const double expected = direct_ssim(a, b, evaluated, w, h);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!evaluated[i]) a[i] = 1e30f, b[i] = std::nanf("");  // what is not evaluated must not matter
  EXPECT_NEAR(ssim({w, h, a, evaluated}, {w, h, b, evaluated}).value(), expected, 1e-12);
  EXPECT_NEAR(ssim({w, h, a, evaluated}, {w, h, b, {}}).value(), expected, 1e-12);
}

TEST(Ssim, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<float> a = noise(200 * 300, 8), b = noise(200 * 300, 9);
  set_threads(1);
  const std::optional<double> one = ssim({200, 300, a, {}}, {200, 300, b, {}});
  set_threads(4);
  EXPECT_EQ(ssim({200, 300, a, {}}, {200, 300, b, {}}), one);
}

TEST(Ssim, NotANumberIsAnError) {
  std::vector<float> a = noise(16, 1), b = a;
  b[5] = std::nanf("");
  EXPECT_NE(test::message_of<InputError>([&] {
              ssim({4, 4, a, {}}, {4, 4, b, {}});
            }).find("(1, 1)"),
            std::string::npos);
}

}  // namespace
}  // namespace penumbra
