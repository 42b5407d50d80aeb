// Structural similarity [Wang 2004]. The five local moments are Gaussian sums, and so separable; a sixth, of
// the evaluated mask itself, is the weight that each window has left, by which the others are divided.
// Deviation: windows at the image's border are cut and renormalised like those at pixels that are not
// evaluated, where the original leaves the border out: an image of any size has a value, and every evaluated
// pixel counts.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "metrics/checks.h"
#include "metrics/metrics.h"

namespace penumbra {
namespace {

constexpr int radius = 5;
constexpr double sigma = 1.5;
constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;

// weight, x, y, x^2, y^2, xy
constexpr std::size_t moments = 6;
using Moments = std::array<double, moments>;

std::array<double, 2 * radius + 1> gaussian_window() {
  std::array<double, 2 * radius + 1> g{};
  for (int k = -radius; k <= radius; ++k)
    g[static_cast<std::size_t>(k + radius)] = std::exp(-0.5 * k * k / (sigma * sigma));
  return g;
}

Moments pixel_moments(const ScalarImage& reference, const ScalarImage& test, std::size_t i) {
  if (!is_evaluated(reference, test, i)) return {};
  check_finite("The reference", reference.values[i], i, reference.width);
  check_finite("The test image", test.values[i], i, test.width);
  const double x = static_cast<double>(reference.values[i]), y = static_cast<double>(test.values[i]);
  return {1, x, y, x * x, y * y, x * y};
}

double similarity(const Moments& m) {
  const double mx = m[1] / m[0], my = m[2] / m[0];
  // What cancellation leaves of a variance may be below 0, and of a covariance beyond what variances allow.
  const double vx = std::max(0.0, m[3] / m[0] - mx * mx), vy = std::max(0.0, m[4] / m[0] - my * my);
  const double limit = std::sqrt(vx * vy), cov = std::clamp(m[5] / m[0] - mx * my, -limit, limit);
  return (2 * (mx * my) + c1) * (2 * cov + c2) / ((mx * mx + my * my + c1) * (vx + vy + c2));
}

// out[x] = sum over the window of g * in, cut at both ends. `in` and `out` hold `width` pixels.
void blur_row(const std::vector<Moments>& in, std::vector<Moments>& out,
              const std::array<double, 2 * radius + 1>& g) {
  const int width = static_cast<int>(in.size());
  for (int x = 0; x < width; ++x) {
    Moments sum{};
    for (int k = std::max(-radius, -x); k <= std::min(radius, width - 1 - x); ++k)
      for (std::size_t c = 0; c < moments; ++c)
        sum[c] += g[static_cast<std::size_t>(k + radius)] * in[static_cast<std::size_t>(x + k)][c];
    out[static_cast<std::size_t>(x)] = sum;
  }
}

struct RowSum {
  double similarity = 0;
  std::size_t pixels = 0;
};

// The rows [begin, end) of the image: each needed row is blurred once and kept in a ring of 2 radius + 1.
void rows(const ScalarImage& reference, const ScalarImage& test, int begin, int end,
          std::vector<RowSum>& sums) {
  const auto g = gaussian_window();
  const std::size_t width = static_cast<std::size_t>(reference.width);
  constexpr int ring_size = 2 * radius + 1;
  std::array<std::vector<Moments>, ring_size> ring;
  ring.fill(std::vector<Moments>(width));
  std::vector<Moments> row(width), total(width);
  int next = std::max(0, begin - radius);
  for (int y = begin; y < end; ++y) {
    const int first = std::max(0, y - radius), last = std::min(reference.height - 1, y + radius);
    for (; next <= last; ++next) {
      const std::size_t start = static_cast<std::size_t>(next) * width;
      for (std::size_t x = 0; x < width; ++x) row[x] = pixel_moments(reference, test, start + x);
      blur_row(row, ring[static_cast<std::size_t>(next % ring_size)], g);
    }
    std::fill(total.begin(), total.end(), Moments{});
    for (int v = first; v <= last; ++v) {
      const std::vector<Moments>& in = ring[static_cast<std::size_t>(v % ring_size)];
      const double weight = g[static_cast<std::size_t>(v - y + radius)];
      for (std::size_t x = 0; x < width; ++x)
        for (std::size_t c = 0; c < moments; ++c) total[x][c] += weight * in[x][c];
    }
    RowSum& sum = sums[static_cast<std::size_t>(y)];
    for (std::size_t x = 0; x < width; ++x) {
      if (!is_evaluated(reference, test, static_cast<std::size_t>(y) * width + x)) continue;
      sum.similarity += similarity(total[x]);
      ++sum.pixels;
    }
  }
}

}  // namespace

std::optional<double> ssim(const ScalarImage& reference, const ScalarImage& test) {
  check_same_size(reference, test);
  if (pixel_count(reference.width, reference.height) == 0) return std::nullopt;
  // Sums per row, added in order: the same for any number of threads.
  std::vector<RowSum> sums(static_cast<std::size_t>(reference.height));
  parallel_for(sums.size(), 64, [&](std::size_t begin, std::size_t end) {
    rows(reference, test, static_cast<int>(begin), static_cast<int>(end), sums);
  });
  RowSum total;
  for (const RowSum& r : sums) total.similarity += r.similarity, total.pixels += r.pixels;
  if (total.pixels == 0) return std::nullopt;
  return total.similarity / static_cast<double>(total.pixels);
}

}  // namespace penumbra
