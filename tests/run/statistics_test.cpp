#include "run/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

namespace penumbra::run {
namespace {

TEST(Quantile, IsLinearBetweenOrderStatistics) {
  const std::vector<double> v = {1, 2, 3, 10};
  EXPECT_DOUBLE_EQ(quantile(v, 0), 1);
  EXPECT_DOUBLE_EQ(quantile(v, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile(v, 1), 10);
  EXPECT_DOUBLE_EQ(quantile(v, 0.95), 3 + 0.85 * 7);  // 0.95 * 3 = 2.85
  EXPECT_DOUBLE_EQ(quantile(std::vector<double>{4}, 0.95), 4);
}

TEST(Summarize, KeepsTheSamplesInTheirOrder) {
  const Stat s = summarize({3, 1, 2});
  EXPECT_EQ(s.samples, (std::vector<double>{3, 1, 2}));
  EXPECT_DOUBLE_EQ(s.median, 2);
  EXPECT_DOUBLE_EQ(s.mean, 2);
  EXPECT_DOUBLE_EQ(s.min, 1);
}

// Seven samples: P(Bin(7, 1/7) >= 4) = 0.010 < 0.025 <= P(Bin(7, 2/7) >= 4) = 0.11, and symmetrically above.
TEST(MedianInterval, IsTheKnownOneForSevenSamples) {
  const auto ci = median_interval(std::vector<double>{1, 2, 3, 4, 5, 6, 7});
  EXPECT_EQ(ci[0], 2);
  EXPECT_EQ(ci[1], 6);
}

TEST(MedianInterval, IsTheSampleItselfForOne) {
  const auto ci = median_interval(std::vector<double>{5});
  EXPECT_EQ(ci[0], 5);
  EXPECT_EQ(ci[1], 5);
}

// What it stands for: the 2.5 % and 97.5 % quantiles of the medians of very many resamples.
TEST(MedianInterval, EqualsTheOneOfManyResamples) {
  std::mt19937_64 random(7);
  for (const std::size_t n : {5U, 9U, 21U, 75U}) {
    std::vector<double> sorted(n);
    for (double& x : sorted) x = std::exp(std::normal_distribution<>()(random));
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> medians(40000), resample(n);
    for (double& m : medians) {
      for (double& x : resample) x = sorted[random() % n];
      std::nth_element(resample.begin(), resample.begin() + static_cast<std::ptrdiff_t>(n / 2),
                       resample.end());
      m = resample[n / 2];
    }
    std::sort(medians.begin(), medians.end());
    const auto rank = [&](double value) {
      return std::lower_bound(sorted.begin(), sorted.end(), value) - sorted.begin();
    };
    const auto ci = median_interval(sorted);
    // A rank of difference is what 40,000 resamples leave open.
    EXPECT_NEAR(double(rank(ci[0])), double(rank(medians[1000])), 1.01) << n;
    EXPECT_NEAR(double(rank(ci[1])), double(rank(medians[39000])), 1.01) << n;
  }
}

// The promise itself: of many experiments with a known median, 95 % of the intervals hold it (the bootstrap
// of small samples is known to fall a little short).
TEST(MedianInterval, CoversTheTrueMedianInNineteenOfTwentyExperiments) {
  std::mt19937_64 random(11);
  int covered = 0;
  constexpr int experiments = 4000;
  for (int i = 0; i < experiments; ++i) {
    std::vector<double> v(41);
    for (double& x : v) x = std::normal_distribution<>(10, 1)(random);
    std::sort(v.begin(), v.end());
    const auto ci = median_interval(v);
    covered += ci[0] <= 10 && 10 <= ci[1];
  }
  EXPECT_GT(covered, experiments * 0.93);
  EXPECT_LT(covered, experiments * 0.98);
}

TEST(MedianInterval, HoldsForManySamples) {
  std::vector<double> v(100000);
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = static_cast<double>(i);
  const auto ci = median_interval(v);
  // Standard deviation of the rank: sqrt(n) / 2 = 158; 1.96 of them on both sides.
  EXPECT_NEAR(ci[0], 50000 - 310, 5);
  EXPECT_NEAR(ci[1], 50000 + 310, 5);
}

TEST(JudgeSamples, FlagsWhatIsFarFromTheOthers) {
  EXPECT_EQ(judge_samples(std::vector<double>{10, 10.1, 9.9, 10.2, 9.8, 30}).outliers, 1U);
  EXPECT_EQ(judge_samples(std::vector<double>{10, 10.1, 9.9, 10.2, 9.8, 10}).outliers, 0U);
  EXPECT_EQ(judge_samples(std::vector<double>{10, 10, 10, 10, 10, 10.005}).outliers, 0U);
}

TEST(JudgeSamples, SeesDriftAndNotNoise) {
  std::vector<double> drifting, noisy;
  for (int i = 0; i < 40; ++i) {
    drifting.push_back(10 + 0.1 * i + 0.05 * (i % 3));
    noisy.push_back(10 + 0.5 * ((i * 7) % 5));
  }
  EXPECT_TRUE(judge_samples(drifting).drifts);
  EXPECT_GT(judge_samples(drifting).drift, 0.1);
  EXPECT_FALSE(judge_samples(noisy).drifts);
}

}  // namespace
}  // namespace penumbra::run
