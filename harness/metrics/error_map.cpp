#include "metrics/error_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "metrics/checks.h"

namespace penumbra {
namespace {

using Color = std::array<uint8_t, 3>;
constexpr Color magenta = {255, 0, 255}, not_evaluated = {64, 64, 64};

// Polar Lab, the space of [Moreland 2009]: magnitude, saturation (angle to the gray axis), hue.
struct Msh {
  double m, s, h;
};
// Cool (59, 76, 192) and warm (180, 4, 38) in it, and the middle's magnitude, as published.
constexpr Msh cool = {80.0, 1.08, -1.1}, warm = {80.0, 1.08, 0.5};
constexpr double middle_magnitude = 88;

// Hue at the gray end, spun so that colours leave their end at right angles to the change of magnitude.
double hue_near_gray(const Msh& end) {
  const double spin =
      end.s * std::sqrt(middle_magnitude * middle_magnitude - end.m * end.m) / (end.m * std::sin(end.s));
  return end.h > -std::numbers::pi / 3 ? end.h + spin : end.h - spin;
}

double inverse_lab_curve(double t) {
  constexpr double delta = 6.0 / 29;
  return t > delta ? t * t * t : 3 * delta * delta * (t - 4.0 / 29);
}

Color srgb_from_msh(const Msh& c) {
  const double lightness = c.m * std::cos(c.s), a = c.m * std::sin(c.s) * std::cos(c.h),
               b = c.m * std::sin(c.s) * std::sin(c.h);
  const double fy = (lightness + 16) / 116;
  const double x = 0.9505 * inverse_lab_curve(fy + a / 500), y = inverse_lab_curve(fy),
               z = 1.089 * inverse_lab_curve(fy - b / 200);
  // XYZ to linear sRGB [IEC 61966-2-1].
  return {srgb_from_linear(static_cast<float>(3.2406 * x - 1.5372 * y - 0.4986 * z)),
          srgb_from_linear(static_cast<float>(-0.9689 * x + 1.8758 * y + 0.0415 * z)),
          srgb_from_linear(static_cast<float>(0.0557 * x - 0.2040 * y + 1.0570 * z))};
}

// t in [-1, 1]
Color exact_color(double t) {
  const Msh& end = t < 0 ? cool : warm;
  const double gray_hue = hue_near_gray(end), u = std::abs(t);
  return srgb_from_msh(
      {middle_magnitude + u * (end.m - middle_magnitude), u * end.s, gray_hue + u * (end.h - gray_hue)});
}

constexpr int half_table = 256;  // steps from 0 to either end

const std::array<Color, 2 * half_table + 1>& color_table() {
  static const auto table = [] {
    std::array<Color, 2 * half_table + 1> colors{};
    for (int i = -half_table; i <= half_table; ++i)
      colors[static_cast<std::size_t>(i + half_table)] = exact_color(static_cast<double>(i) / half_table);
    return colors;
  }();
  return table;
}

}  // namespace

std::array<uint8_t, 3> diverging_color(double t) {
  if (std::isnan(t)) return magenta;
  const long entry = std::lround(std::clamp(t, -1.0, 1.0) * half_table);
  return color_table()[static_cast<std::size_t>(entry + half_table)];
}

Rgb8Image error_map(const ScalarImage& reference, const ScalarImage& test, double scale) {
  check_same_size(reference, test);
  if (!(scale > 0 && std::isfinite(scale)))
    throw InputError("An error map cannot have the scale " + std::to_string(scale) +
                     "; expected a number above 0.");
  Rgb8Image image{reference.width, reference.height, std::vector<uint8_t>(3 * reference.values.size())};
  parallel_for(reference.values.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Color color = not_evaluated;
      if (is_evaluated(reference, test, i)) {
        const double r = static_cast<double>(reference.values[i]), t = static_cast<double>(test.values[i]);
        color = std::isfinite(r) && std::isfinite(t) ? diverging_color((t - r) / scale) : magenta;
      }
      std::copy(color.begin(), color.end(), image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
  });
  return image;
}

Rgb8Image error_color_bar(int width, int height) {
  Rgb8Image image{width, height, {}};
  image.rgb.reserve(3 * pixel_count(width, height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Color color = diverging_color(width > 1 ? 2.0 * x / (width - 1) - 1 : 0);
      image.rgb.insert(image.rgb.end(), color.begin(), color.end());
    }
  return image;
}

}  // namespace penumbra
