#include "compare/significance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace penumbra::compare {
namespace {

constexpr std::size_t exact_limit = 20;  // values a side

// Twice the mid-rank of each value of both sets together, those of `earlier` first: integers, also for ties.
std::vector<std::size_t> doubled_ranks(std::span<const double> earlier, std::span<const double> later) {
  std::vector<double> all(earlier.begin(), earlier.end());
  all.insert(all.end(), later.begin(), later.end());
  std::vector<std::size_t> order(all.size()), ranks(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return all[a] < all[b]; });
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && all[order[end]] == all[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i)
      ranks[order[i]] = begin + 1 + end;  // 2 (mean of begin+1 .. end)
    begin = end;
  }
  return ranks;
}

// Of all ways to choose `count` of the ranks, the share whose sum is at least `sum`.
double exact_tail(const std::vector<std::size_t>& ranks, std::size_t count, std::size_t sum) {
  const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  // ways[k][s]: choices of k ranks that sum to s. Doubles hold them exactly enough: 40 choose 20 is 1.4e11.
  std::vector<std::vector<double>> ways(count + 1, std::vector<double>(total + 1, 0.0));
  ways[0][0] = 1;
  for (const std::size_t rank : ranks)
    for (std::size_t k = count; k-- > 0;)
      for (std::size_t s = total + 1 - rank; s-- > 0;) ways[k + 1][s + rank] += ways[k][s];
  const auto& row = ways[count];
  const auto from = row.begin() + static_cast<std::ptrdiff_t>(std::min(sum, total + 1));
  return std::accumulate(from, row.end(), 0.0) / std::accumulate(row.begin(), row.end(), 0.0);
}

double normal_tail(const std::vector<std::size_t>& ranks, double n, double m, double doubled_sum) {
  const double all = n + m, mean = m * (all + 1) / 2;
  double square = 0;  // the ranks' variance holds the correction for ties
  for (const std::size_t r : ranks) square += std::pow(double(r) / 2 - (all + 1) / 2, 2);
  const double variance = n * m / (all * (all - 1)) * square;
  if (variance <= 0) return 1;
  return 0.5 * std::erfc((doubled_sum / 2 - 0.5 - mean) / std::sqrt(2 * variance));
}

// Block i of `blocks` consecutive ones of nearly equal length.
std::vector<double> block(std::span<const double> values, std::size_t i, std::size_t blocks) {
  const std::size_t begin = values.size() * i / blocks, end = values.size() * (i + 1) / blocks;
  return {values.begin() + static_cast<std::ptrdiff_t>(begin),
          values.begin() + static_cast<std::ptrdiff_t>(end)};
}

}  // namespace

double median(std::vector<double> values) {
  assert(!values.empty());
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double mann_whitney_greater(std::span<const double> earlier, std::span<const double> later) {
  if (earlier.empty() || later.empty()) return 1;
  const auto ranks = doubled_ranks(earlier, later);
  const auto first = ranks.begin() + static_cast<std::ptrdiff_t>(earlier.size());
  const std::size_t sum = std::accumulate(first, ranks.end(), std::size_t{0});
  if (std::max(earlier.size(), later.size()) <= exact_limit) return exact_tail(ranks, later.size(), sum);
  return normal_tail(ranks, double(earlier.size()), double(later.size()), double(sum));
}

double smallest_p(std::size_t n, std::size_t m) {
  if (n == 0 || m == 0) return 1;
  const double a = double(n), b = double(m);
  return std::exp(std::lgamma(a + 1) + std::lgamma(b + 1) - std::lgamma(a + b + 1));
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double last = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    last = std::max(last, std::min(1.0, p[order[i]] * double(p.size() - i)));
    adjusted[order[i]] = last;
  }
  return adjusted;
}

std::vector<double> ratio_samples(std::span<const double> times, std::span<const double> anchor) {
  const std::size_t blocks = std::min(times.size(), anchor.size());
  std::vector<double> ratios;
  for (std::size_t i = 0; i < blocks; ++i)
    if (const double below = median(block(anchor, i, blocks)); below > 0)
      ratios.push_back(median(block(times, i, blocks)) / below);
  return ratios;
}

}  // namespace penumbra::compare
