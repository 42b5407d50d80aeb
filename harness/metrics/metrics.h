// Image errors, given over evaluated pixels only, and per zone of the reference.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"

namespace penumbra {

// An image of visibility (or any scalar) and which of its pixels count. An empty `evaluated` means all.
struct ScalarImage {
  int width = 0, height = 0;
  std::span<const float> values;
  std::span<const uint8_t> evaluated;
};

struct ZoneErrors {
  std::size_t pixels = 0;
  double mae = 0, bias = 0;
};

// Metrics that have no value (no evaluated pixel, PSNR of equal images) are empty and become null in JSON.
struct ImageErrors {
  std::optional<double> mae, rmse, max, psnr, ssim, bias;  // bias: mean of test - reference
  std::optional<double> acne;  // share of lit pixels (reference 1) that test darkens by more than 1/512
  std::optional<double> leak;  // share of umbra pixels (reference 0) that test lights by more than 1/512
  ZoneErrors umbra, penumbra, lit;
  std::size_t evaluated_pixels = 0;
};

// Throws InputError when sizes differ. Values that are not finite in evaluated pixels are an InputError too,
// naming the pixel: a metric never hides a NaN. Pixels count that are evaluated in both.
ImageErrors image_errors(const ScalarImage& reference, const ScalarImage& test);
// The same without `ssim`, which takes most of the time.
ImageErrors pixel_errors(const ScalarImage& reference, const ScalarImage& test);

// Mean structural similarity [Wang 2004]: 11 x 11 Gaussian window, sigma 1.5, K1 = 0.01, K2 = 0.03, data
// range 1, averaged over evaluated pixels; windows use evaluated pixels only (weights renormalised).
std::optional<double> ssim(const ScalarImage& reference, const ScalarImage& test);

struct MaskMismatch {
  uint64_t bits_off = 0, bits = 0;
  uint64_t pixels_off = 0, pixels = 0;
  double mask_bit_mismatch() const { return bits ? double(bits_off) / double(bits) : 0; }
};
MaskMismatch mask_mismatch(std::span<const uint32_t> reference, std::span<const uint32_t> test,
                           int words_per_pixel, int light_samples, std::span<const uint8_t> evaluated);

// LDR-FLIP [Andersson 2020] with its errata (division by 116; mean over pixels): linear RGB in [0, 1] in, the
// error map in [0, 1] and its mean out. 67 pixels per degree is the published default.
struct FlipResult {
  double mean = 0;
  std::vector<float> map;
};
FlipResult flip(std::span<const Vec3f> reference, std::span<const Vec3f> test, int width, int height,
                double pixels_per_degree = 67.0);

}  // namespace penumbra
