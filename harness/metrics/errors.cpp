// Differences pixel by pixel, summed in double.
#include <algorithm>
#include <cmath>

#include "metrics/checks.h"
#include "metrics/metrics.h"

namespace penumbra {
namespace {

// A pixel of 256 light samples changes by 1/256 when one of them does: half of that is no error but rounding.
constexpr double visible_difference = 1.0 / 512;

struct Sums {
  std::size_t pixels = 0;
  double absolute = 0, signed_difference = 0;
  void add(double d) { ++pixels, absolute += std::abs(d), signed_difference += d; }
  void add(const Sums& s) {
    pixels += s.pixels, absolute += s.absolute, signed_difference += s.signed_difference;
  }
  double mae() const { return pixels ? absolute / static_cast<double>(pixels) : 0; }
  double bias() const { return pixels ? signed_difference / static_cast<double>(pixels) : 0; }
};

struct RowSums {
  Sums all, umbra, penumbra, lit;
  double squared = 0, max = 0;
  std::size_t acne = 0, leak = 0;

  void add(double reference, double test) {
    const double d = test - reference;
    all.add(d);
    squared += d * d;
    max = std::max(max, std::abs(d));
    if (reference <= 0) {
      umbra.add(d);
      leak += d > visible_difference;
    } else if (reference >= 1) {
      lit.add(d);
      acne += d < -visible_difference;
    } else {
      penumbra.add(d);
    }
  }
  void add(const RowSums& r) {
    all.add(r.all), umbra.add(r.umbra), penumbra.add(r.penumbra), lit.add(r.lit);
    squared += r.squared, max = std::max(max, r.max), acne += r.acne, leak += r.leak;
  }
};

RowSums row_sums(const ScalarImage& reference, const ScalarImage& test, std::size_t y) {
  const std::size_t width = static_cast<std::size_t>(reference.width);
  RowSums sums;
  for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
    if (!is_evaluated(reference, test, i)) continue;
    check_finite("The reference", reference.values[i], i, reference.width);
    check_finite("The test image", test.values[i], i, test.width);
    sums.add(static_cast<double>(reference.values[i]), static_cast<double>(test.values[i]));
  }
  return sums;
}

std::optional<double> share(std::size_t part, std::size_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

ZoneErrors zone(const Sums& s) { return {s.pixels, s.mae(), s.bias()}; }

}  // namespace

ImageErrors pixel_errors(const ScalarImage& reference, const ScalarImage& test) {
  check_same_size(reference, test);
  const std::size_t rows =
      pixel_count(reference.width, reference.height) ? static_cast<std::size_t>(reference.height) : 0;
  // Serial and row by row: short sums lose few digits, the first non-finite pixel in reading order is the one
  // that is named, and the loop is bound by memory.
  RowSums sums;
  for (std::size_t y = 0; y < rows; ++y) sums.add(row_sums(reference, test, y));

  ImageErrors e;
  e.evaluated_pixels = sums.all.pixels;
  e.umbra = zone(sums.umbra), e.penumbra = zone(sums.penumbra), e.lit = zone(sums.lit);
  e.acne = share(sums.acne, sums.lit.pixels);
  e.leak = share(sums.leak, sums.umbra.pixels);
  if (sums.all.pixels == 0) return e;
  const double mse = sums.squared / static_cast<double>(sums.all.pixels);
  e.mae = sums.all.mae(), e.bias = sums.all.bias(), e.max = sums.max;
  e.rmse = std::sqrt(mse);
  if (mse > 0) e.psnr = -10 * std::log10(mse);
  return e;
}

ImageErrors image_errors(const ScalarImage& reference, const ScalarImage& test) {
  ImageErrors e = pixel_errors(reference, test);
  e.ssim = ssim(reference, test);
  return e;
}

}  // namespace penumbra
