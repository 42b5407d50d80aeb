#include "compare/significance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

namespace penumbra::compare {
namespace {

using Values = std::vector<double>;

TEST(MannWhitney, OfSeparatedValuesIsOneOverTheNumberOfChoices) {
  EXPECT_DOUBLE_EQ(mann_whitney_greater(Values{1, 2, 3}, Values{4, 5, 6}), 1.0 / 20);
  EXPECT_DOUBLE_EQ(mann_whitney_greater(Values{4, 5, 6}, Values{1, 2, 3}), 1);
  EXPECT_NEAR(smallest_p(3, 3), 1.0 / 20, 1e-12);
  EXPECT_NEAR(smallest_p(7, 7), 1.0 / 3432, 1e-12);
}

// The exact tail by enumeration of all choices, ties included.
double enumerated(const Values& a, const Values& b) {
  Values all = a;
  all.insert(all.end(), b.begin(), b.end());
  const auto rank = [&](double x) {
    double r = 0.5;
    for (const double y : all) r += y < x ? 1 : y == x ? 0.5 : 0;
    return r;
  };
  double found = 0;
  for (const double x : b) found += rank(x);
  std::size_t choices = 0, as_high = 0;
  for (unsigned bits = 0; bits < 1U << all.size(); ++bits) {
    if (static_cast<std::size_t>(std::popcount(bits)) != b.size()) continue;
    double sum = 0;
    for (std::size_t i = 0; i < all.size(); ++i) sum += bits >> i & 1 ? rank(all[i]) : 0;
    ++choices;
    as_high += sum >= found - 1e-9;
  }
  return double(as_high) / double(choices);
}

TEST(MannWhitney, EqualsTheEnumerationOfAllChoices) {
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    Values a(1 + random() % 6), b(1 + random() % 6);
    for (double& x : a) x = double(random() % 6);  // many ties
    for (double& x : b) x = double(random() % 6) + i % 3;
    EXPECT_NEAR(mann_whitney_greater(a, b), enumerated(a, b), 1e-12);
  }
}

TEST(MannWhitney, IsCertainOfNothingWhenAllIsEqualOrEmpty) {
  EXPECT_DOUBLE_EQ(mann_whitney_greater(Values{2, 2, 2}, Values{2, 2, 2}), 1);
  EXPECT_DOUBLE_EQ(mann_whitney_greater(Values(50, 2.0), Values(50, 2.0)), 1);
  EXPECT_DOUBLE_EQ(mann_whitney_greater(Values{}, Values{1}), 1);
}

TEST(MannWhitney, GoesOverToTheNormalApproximationWithoutAStep) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Values a, b;
  for (int i = 0; i < 20; ++i) a.push_back(normal(random)), b.push_back(normal(random) + 0.5);
  const double exact = mann_whitney_greater(a, b);
  a.push_back(0), b.push_back(0.5);
  EXPECT_NEAR(std::log(mann_whitney_greater(a, b)), std::log(exact), 0.5);
}

// The level holds: under equal distributions p <= 0.05 in at most 5 % of draws, and p is not idle.
TEST(MannWhitney, KeepsItsLevel) {
  std::mt19937 random(11);
  std::lognormal_distribution<double> skewed(0, 0.3);
  int rejected = 0;
  constexpr int draws = 4000;
  for (int i = 0; i < draws; ++i) {
    Values a(8), b(8);
    for (double& x : a) x = skewed(random);
    for (double& x : b) x = skewed(random);
    rejected += mann_whitney_greater(a, b) <= 0.05;
  }
  EXPECT_LT(rejected, draws * 0.06);
  EXPECT_GT(rejected, draws * 0.035);
}

TEST(Holm, MultipliesByTheNumberLeftAndStaysOrdered) {
  const Values adjusted = holm(Values{0.01, 0.04, 0.03, 0.9});
  EXPECT_DOUBLE_EQ(adjusted[0], 0.04);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.09);
  EXPECT_DOUBLE_EQ(adjusted[1], 0.09);  // 0.08 would be below the one before
  EXPECT_DOUBLE_EQ(adjusted[3], 0.9);
  EXPECT_TRUE(holm(Values{}).empty());
}

TEST(RatioSamples, TakeOutWhatSlowsBothSidesDownTogether) {
  Values times, anchor;
  for (int i = 0; i < 12; ++i) {
    const double load = i < 6 ? 1 : 1.4;  // another process comes in half way
    times.push_back(3 * load), anchor.push_back(2 * load);
  }
  for (const double r : ratio_samples(times, anchor)) EXPECT_DOUBLE_EQ(r, 1.5);
}

TEST(RatioSamples, AreAsManyAsTheShorterSideHas) {
  const Values many = {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4};
  const Values r = ratio_samples(many, Values{1, 2, 3});
  ASSERT_EQ(r.size(), 3U);
  EXPECT_DOUBLE_EQ(r[0], 1);
  EXPECT_TRUE(ratio_samples(many, Values{}).empty());
  EXPECT_TRUE(ratio_samples(many, Values{0, 0}).empty());  // nothing to divide by
}

}  // namespace
}  // namespace penumbra::compare
