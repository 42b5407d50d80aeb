// The per-pixel test on pictures whose truth and whose noise are known.
#include "metrics/pixel_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/error.h"

namespace penumbra {
namespace {

constexpr int side = 48, batches = 8;

// A penumbra that fills the picture: truth rises from left to right, with a lit and a dark border.
std::vector<float> ramp() {
  std::vector<float> v(side * side);
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] = std::clamp(1.25f * float(i % side) / float(side - 1) - 0.125f, 0.f, 1.f);
  return v;
}

struct Estimate {
  std::vector<float> mean, error;
};

// A reference made as the suite's is: batches of `per_batch` random light samples, in each pixel the share of
// those that see the light. `shared`: all pixels have the same samples, so that their noise is one; else each
// its own.
Estimate estimate(const std::vector<float>& truth, int per_batch, bool shared, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0, 1);
  std::array<std::vector<float>, batches> samples;
  const auto draw = [&] {
    for (auto& batch : samples) {
      batch.resize(static_cast<std::size_t>(per_batch));
      for (float& u : batch) u = uniform(random);
    }
  };
  Estimate out;
  if (shared) draw();
  for (const float v : truth) {
    if (!shared) draw();
    double sum = 0, squares = 0;
    for (const auto& batch : samples) {
      const double share = double(std::ranges::count_if(batch, [v](float u) { return u < v; })) / per_batch;
      sum += share, squares += share * share;
    }
    const double mean = sum / batches, variance = (squares - sum * mean) / (batches - 1);
    out.mean.push_back(float(mean));
    out.error.push_back(float(std::sqrt(std::max(variance, 0.0) / batches)));
  }
  return out;
}

PixelTest judged(const std::vector<float>& before, const std::vector<float>& after, const Estimate& e,
                 int per_batch) {
  return test_pixels(before, after, {e.mean, e.error, per_batch * batches, batches});
}

TEST(StudentTail, IsThatOfTheTables) {
  EXPECT_NEAR(student_tail(0, 7), 0.5, 1e-14);
  EXPECT_NEAR(student_tail(1.894579, 7), 0.05, 1e-7);
  EXPECT_NEAR(student_tail(4.785290, 7), 0.001, 1e-8);
  EXPECT_NEAR(student_tail(-1.894579, 7), 0.95, 1e-7);
  for (const double t : {0.1, 1.0, 30.0, 1e4})  // Cauchy
    EXPECT_NEAR(student_tail(t, 1) / (std::atan2(1, t) / std::numbers::pi), 1, 1e-10) << t;
  for (const double t : {0.1, 1.0, 30.0, 1e3})  // two degrees of freedom have a closed form
    EXPECT_NEAR(student_tail(t, 2) / (1 / (std::sqrt(2 + t * t) * (std::sqrt(2 + t * t) + t))), 1, 1e-10)
        << t;
}

TEST(Hommel, IsThePValueOfOneAndNeverBelowTheLeastOfMany) {
  std::vector<double> one = {0.03}, none, same(10, 0.01), mixed = {0.9, 0.001, 0.5, 0.02};
  EXPECT_DOUBLE_EQ(hommel(one), 0.03);
  EXPECT_DOUBLE_EQ(hommel(none), 1);
  const double ten = 7381.0 / 2520, four = 25.0 / 12;  // harmonic sums
  EXPECT_NEAR(hommel(same), 0.01 * ten, 1e-15);
  EXPECT_NEAR(hommel(mixed), 0.004 * four, 1e-15);
}

// Equally far from the truth on both sides is the worst that is still no regression. Every pixel has changed,
// and every one is at the border of what the test calls farther.
TEST(PixelTest, CallsNoMoreThanItsShareOfEqualPicturesFarther) {
  std::mt19937 random(1);
  const std::vector<float> truth = ramp();
  constexpr double alpha = 0.05;
  for (const bool shared : {false, true})
    for (const int per_batch : {4, 32}) {
      const int trials = shared ? 300 : 40;
      int alarms = 0;
      for (int trial = 0; trial < trials; ++trial) {
        std::vector<float> before = truth, after = truth;
        std::bernoulli_distribution coin(0.5);
        for (std::size_t i = 0; i < truth.size(); ++i) {
          const float d = coin(random) ? 0.06f : -0.06f;
          before[i] -= d, after[i] += d;
        }
        const PixelTest t = judged(before, after, estimate(truth, per_batch, shared, random), per_batch);
        EXPECT_EQ(t.changed, truth.size());
        alarms += t.p_farther <= alpha;
      }
      // Three standard deviations of what `alpha` allows.
      EXPECT_LE(alarms, alpha * trials + 3 * std::sqrt(alpha * (1 - alpha) * trials))
          << shared << ' ' << per_batch;
    }
}

TEST(PixelTest, FindsAnErrorInOnePixelOfAHundred) {
  std::mt19937 random(2);
  const std::vector<float> truth = ramp();
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<float> after = truth;
    const Estimate e = estimate(truth, 512, true, random);
    std::vector<std::size_t> wrong;
    for (std::size_t i = std::size_t(trial); i < truth.size(); i += 100) {
      after[i] += after[i] < 0.5f ? 0.25f : -0.25f;
      wrong.push_back(i);
    }
    const PixelTest t = judged(truth, after, e, 512);
    EXPECT_EQ(t.changed, wrong.size());
    EXPECT_LE(t.p_farther, 0.002);
    EXPECT_EQ(t.farther, wrong.size());
    EXPECT_EQ(t.nearer, 0U);
    ASSERT_TRUE(t.worst.has_value());
    EXPECT_TRUE(std::ranges::find(wrong, *t.worst) != wrong.end());
    const PixelTest cured = judged(after, truth, e, 512);
    EXPECT_LE(cured.p_nearer, 0.002);
    EXPECT_GT(cured.p_farther, 0.5);
    EXPECT_EQ(cured.farther, 0U);
  }
}

TEST(PixelTest, SaysNothingOfEqualPicturesAndChangesBelowOneLightSample) {
  std::mt19937 random(3);
  const std::vector<float> truth = ramp();
  const Estimate e = estimate(truth, 32, true, random);
  const PixelTest same = judged(truth, truth, e, 32);
  EXPECT_EQ(same.changed, 0U);
  EXPECT_EQ(same.p_farther, 1);
  EXPECT_FALSE(same.worst.has_value());
  std::vector<float> rounded = truth;
  for (float& v : rounded) v = std::nextafter(v, 2.f);
  EXPECT_GT(judged(truth, rounded, e, 32).p_farther, 0.2);
}

TEST(PixelTest, RefusesOtherSizesAndReferencesWithoutBatches) {
  const std::vector<float> four(4, 0.5f), three(3, 0.5f);
  EXPECT_THROW(test_pixels(four, three, {four, four, 64, 8}), InputError);
  EXPECT_THROW(test_pixels(four, four, {four, three, 64, 8}), InputError);
  EXPECT_THROW(test_pixels(four, four, {four, four, 1, 1}), InputError);
}

}  // namespace
}  // namespace penumbra
