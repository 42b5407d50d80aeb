#include "run/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

namespace penumbra::run {
namespace {

// P(Bin(n, p) >= r), summed from the largest term outwards so that long tails of tiny terms cost nothing.
double binomial_tail(std::size_t n, double p, std::size_t r) {
  if (p <= 0) return r == 0 ? 1 : 0;
  if (p >= 1) return 1;
  const double dn = static_cast<double>(n);
  const auto log_term = [&](double i) {
    return std::lgamma(dn + 1) - std::lgamma(i + 1) - std::lgamma(dn - i + 1) + i * std::log(p) +
           (dn - i) * std::log1p(-p);
  };
  const auto mode = static_cast<std::size_t>(std::min(dn, std::floor((dn + 1) * p)));
  const std::size_t from = std::max(mode, r);
  double sum = 0;
  const double first = std::exp(log_term(static_cast<double>(from)));
  for (double i = static_cast<double>(from), t = first; i <= dn && t > 1e-18 * sum; ++i) {
    sum += t;
    t *= (dn - i) / (i + 1) * p / (1 - p);
  }
  double t = first;
  for (std::size_t i = from; i > r; --i) {
    const double di = static_cast<double>(i);
    t *= di / (dn - di + 1) * (1 - p) / p;
    if (t <= 1e-18 * sum) break;
    sum += t;
  }
  return std::min(sum, 1.0);
}

// Smallest k in 1..n with P(X*_(r) <= x_(k)) >= q.
std::size_t bootstrap_rank(std::size_t n, std::size_t r, double q) {
  std::size_t lo = 1, hi = n;
  while (lo < hi) {
    const std::size_t k = (lo + hi) / 2;
    if (binomial_tail(n, static_cast<double>(k) / static_cast<double>(n), r) >= q)
      hi = k;
    else
      lo = k + 1;
  }
  return lo;
}

}  // namespace

double quantile(std::span<const double> ascending, double q) {
  assert(!ascending.empty());
  const double at = q * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  const double fraction = at - static_cast<double>(below);
  return ascending[below] + (ascending[above] - ascending[below]) * fraction;
}

std::array<double, 2> median_interval(std::span<const double> ascending) {
  const std::size_t n = ascending.size();
  assert(n > 0);
  const std::size_t lower_middle = (n + 1) / 2, upper_middle = n / 2 + 1;
  return {ascending[bootstrap_rank(n, lower_middle, 0.025) - 1],
          ascending[bootstrap_rank(n, upper_middle, 0.975) - 1]};
}

Stat summarize(std::vector<double> samples) {
  assert(!samples.empty());
  std::vector<double> ascending = samples;
  std::sort(ascending.begin(), ascending.end());
  Stat s;
  s.median = quantile(ascending, 0.5);
  s.mean = std::accumulate(ascending.begin(), ascending.end(), 0.0) / static_cast<double>(ascending.size());
  s.min = ascending.front();
  s.p95 = quantile(ascending, 0.95);
  s.ci95 = median_interval(ascending);
  s.samples = std::move(samples);
  return s;
}

SampleQuality judge_samples(std::span<const double> in_order) {
  SampleQuality quality;
  if (in_order.size() < 4) return quality;
  const auto sorted = [](std::span<const double> s) {
    std::vector<double> v(s.begin(), s.end());
    std::sort(v.begin(), v.end());
    return v;
  };
  const double median = quantile(sorted(in_order), 0.5);
  std::vector<double> deviations;
  for (double x : in_order) deviations.push_back(std::abs(x - median));
  // 1.4826 scales the median absolute deviation to a Gaussian's standard deviation. The floor keeps a
  // quantised clock, which gives equal samples and a deviation of 0, from calling its next tick an outlier.
  const double scale = std::max(1.4826 * quantile(sorted(deviations), 0.5), 1e-3 * std::abs(median));
  for (double d : deviations) quality.outliers += d > 5 * scale;
  if (in_order.size() < 8 || median <= 0) return quality;
  const auto early = sorted(in_order.first(in_order.size() / 2));
  const auto late = sorted(in_order.last(in_order.size() / 2));
  quality.drift = (quantile(late, 0.5) - quantile(early, 0.5)) / median;
  const auto a = median_interval(early), b = median_interval(late);
  quality.drifts = std::abs(quality.drift) > 0.05 && (a[1] < b[0] || b[1] < a[0]);
  return quality;
}

nlohmann::json to_json(const Stat& s) {
  return {{"median", s.median}, {"mean", s.mean}, {"min", s.min},
          {"p95", s.p95},       {"ci95", s.ci95}, {"samples", s.samples}};
}

}  // namespace penumbra::run
