// Whether two sets of repeated measurements differ by more than chance.
#pragma once
#include <span>
#include <vector>

namespace penumbra::compare {

double median(std::vector<double> values);  // must not be empty

// One-sided p value of the Mann-Whitney test: the probability of ranks of `later` at least as high when both
// come from one distribution. Exact (the permutation distribution of the rank sum, ties included) up to 20
// values a side; beyond, the normal approximation with correction for ties and continuity. 1 when either is
// empty.
double mann_whitney_greater(std::span<const double> earlier, std::span<const double> later);

// The smallest p that the test can give for so many values: 1 / (n + m choose n).
double smallest_p(std::size_t n, std::size_t m);

// Holm's correction: p values such that rejecting those at or below alpha keeps the probability of any false
// rejection at or below alpha, whatever the dependence between the tests.
std::vector<double> holm(std::span<const double> p);

// Times as multiples of an anchor that was measured in the same run, repetitions of both interleaved: both
// sequences are cut into as many consecutive blocks as the shorter one has values, and each block gives the
// ratio of its medians. What drifts during the run meets both sides of each ratio alike.
std::vector<double> ratio_samples(std::span<const double> times, std::span<const double> anchor);

}  // namespace penumbra::compare
