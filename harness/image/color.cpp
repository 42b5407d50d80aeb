// The sRGB transfer function [IEC 61966-2-1] both ways.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/parallel.h"
#include "image/image.h"

namespace penumbra {
namespace {

double decode(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// Entry i: the linear value at which rounding goes from code i to i + 1. A search among them is exact and
// monotone, and several times faster than a power per value.
std::array<float, 255> code_borders() {
  std::array<float, 255> borders{};
  for (std::size_t i = 0; i < borders.size(); ++i)
    borders[i] = static_cast<float>(decode((static_cast<double>(i) + 0.5) / 255));
  return borders;
}

std::array<float, 256> code_values() {
  std::array<float, 256> values{};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(decode(static_cast<double>(i) / 255));
  return values;
}

}  // namespace

uint8_t srgb_from_linear(float v) {
  static const std::array<float, 255> borders = code_borders();
  if (std::isnan(v)) return 0;
  return static_cast<uint8_t>(std::upper_bound(borders.begin(), borders.end(), v) - borders.begin());
}

float linear_from_srgb(uint8_t v) {
  static const std::array<float, 256> values = code_values();
  return values[v];
}

Rgb8Image tonemap(std::span<const Vec3f> linear, int width, int height) {
  assert(linear.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  Rgb8Image image{width, height, std::vector<uint8_t>(3 * linear.size())};
  parallel_for(linear.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f& c = linear[i];
      uint8_t* out = &image.rgb[3 * i];
      if (std::isnan(c.x) || std::isnan(c.y) || std::isnan(c.z))
        out[0] = out[2] = 255, out[1] = 0;
      else
        for (int k = 0; k < 3; ++k) out[k] = srgb_from_linear(c[k]);
    }
  });
  return image;
}

}  // namespace penumbra
