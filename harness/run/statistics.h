// What is said about repeated measurements. Raw samples are kept; everything else is derived from them here.
#pragma once
#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

namespace penumbra::run {

struct Stat {
  double median = 0, mean = 0, min = 0, p95 = 0;
  std::array<double, 2> ci95{};  // of the median
  std::vector<double> samples;   // in the order in which they were taken
};

// Quantile q in [0, 1] of ascending values, linear between order statistics (type 7 of Hyndman and Fan 1996).
double quantile(std::span<const double> ascending, double q);

// 95 % percentile-bootstrap interval of the median of ascending values. The bootstrap distribution of an
// order statistic is known in closed form - P(X*_(r) <= x_(k)) = P(Bin(n, k/n) >= r) - so nothing is drawn at
// random: this is the limit of infinitely many resamples. For even n the lower end is the lower middle's, the
// upper end the upper's.
std::array<double, 2> median_interval(std::span<const double> ascending);

// `samples` must not be empty.
Stat summarize(std::vector<double> samples);

// What a reader should know before trusting a sample: flagged, never dropped.
struct SampleQuality {
  std::size_t outliers = 0;  // further from the median than 5 scaled median absolute deviations
  double drift = 0;          // (median of the later half - median of the earlier half) / median
  bool drifts = false;       // |drift| > 5 % and the halves' intervals do not overlap
};
SampleQuality judge_samples(std::span<const double> in_order);

nlohmann::json to_json(const Stat& stat);

}  // namespace penumbra::run
