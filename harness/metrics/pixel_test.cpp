#include "metrics/pixel_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace penumbra {
namespace {

// The continued fraction of the incomplete beta function, by Lentz's method.
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  const auto away_from_zero = [](double v) { return std::abs(v) < tiny ? tiny : v; };
  double c = 1, d = 1 / away_from_zero(1 - (a + b) * x / (a + 1)), f = d;
  for (int m = 1; m <= 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away_from_zero(1 + even * d), c = away_from_zero(1 + even / c);
    f *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away_from_zero(1 + odd * d), c = away_from_zero(1 + odd / c);
    const double step = d * c;
    f *= step;
    if (std::abs(step - 1) < 1e-14) break;
  }
  return f;
}

// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a
                                   : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

void check(std::span<const float> before, std::span<const float> after, const EstimatedTruth& truth) {
  const std::size_t n = truth.visibility.size();
  if (before.size() != n || after.size() != n || truth.standard_error.size() != n)
    throw InputError(fmt::format("pictures of {} and {} pixels have a reference of {} and {}.", before.size(),
                                 after.size(), n, truth.standard_error.size()));
  if (truth.light_samples < 1 || truth.batches < 2)
    throw InputError("a reference without batches of light samples has no variance.");
}

}  // namespace

double student_tail(double t, int degrees_of_freedom) {
  const double n = degrees_of_freedom, tail = 0.5 * incomplete_beta(n / 2, 0.5, n / (n + t * t));
  return t >= 0 ? tail : 1 - tail;
}

double hommel(std::span<double> p) {
  if (p.empty()) return 1;
  std::ranges::sort(p);
  const double n = static_cast<double>(p.size());
  double least = 1, harmonic = 0;
  for (std::size_t k = 1; k <= p.size(); ++k) {
    least = std::min(least, n / static_cast<double>(k) * p[k - 1]);
    harmonic += 1 / static_cast<double>(k);
  }
  return std::min(1.0, harmonic * least);
}

PixelTest test_pixels(std::span<const float> before, std::span<const float> after,
                      const EstimatedTruth& truth) {
  check(before, after, truth);
  PixelTest out;
  out.pixels = before.size();
  const double least_error = 1.0 / truth.light_samples;
  std::vector<double> farther, nearer;
  double worst = PixelTest::level;
  for (std::size_t i = 0; i < before.size(); ++i) {
    // A value that is no number is a change that nothing says anything good of; such pictures are not
    // written.
    if (before[i] == after[i]) continue;
    const double b = before[i], a = after[i], t = truth.visibility[i];
    const double error = std::max<double>(truth.standard_error[i], least_error);
    const double z = (a > b ? 1 : -1) * (0.5 * (a + b) - t) / error;
    farther.push_back(student_tail(z, truth.batches - 1));
    nearer.push_back(student_tail(-z, truth.batches - 1));
    out.farther += farther.back() <= PixelTest::level, out.nearer += nearer.back() <= PixelTest::level;
    if (farther.back() <= worst) worst = farther.back(), out.worst = i;
  }
  out.changed = farther.size();
  out.p_farther = hommel(farther);
  out.p_nearer = hommel(nearer);
  return out;
}

}  // namespace penumbra
