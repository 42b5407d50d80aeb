#include "image/false_color.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

const std::vector<Rgb8>& false_color_stops() {
  // Brightness (CIE L*) rises evenly from 10 to 95.
  static const std::vector<Rgb8> stops{{38, 8, 72},    {84, 15, 109},  {128, 31, 108},
                                       {171, 48, 91},  {209, 73, 64},  {236, 108, 36},
                                       {248, 153, 30}, {246, 201, 68}, {250, 246, 170}};
  return stops;
}

Rgb8 false_color(double t) {
  const std::vector<Rgb8>& stops = false_color_stops();
  const double at = std::clamp(std::isfinite(t) ? t : 0.0, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double f = at - static_cast<double>(i);
  Rgb8 color;
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = static_cast<uint8_t>(std::lround(stops[i][c] + f * (stops[i + 1][c] - stops[i][c])));
  return color;
}

Rgb8 class_color(std::size_t index) {
  static constexpr std::array<Rgb8, 8> colors{{{0, 114, 178},
                                               {230, 159, 0},
                                               {0, 158, 115},
                                               {204, 121, 167},
                                               {86, 180, 233},
                                               {213, 94, 0},
                                               {240, 228, 66},
                                               {150, 150, 150}}};
  return colors[index % colors.size()];
}

std::string hex(Rgb8 color) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text = "#";
  for (const uint8_t c : color) text += {digits[c >> 4], digits[c & 15]};
  return text;
}

void blend(Rgb8Image& image, int x, int y, Rgb8 over, double share) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  for (std::size_t c = 0; c < 3; ++c)
    image.rgb[at + c] =
        static_cast<uint8_t>(std::lround(image.rgb[at + c] + share * (over[c] - image.rgb[at + c])));
}

void draw_line(Rgb8Image& image, Vec2d a, Vec2d b, Rgb8 color, const LineShare& share) {
  // Only the part over the picture is walked: an end may be very far away.
  double begin = 0, end = 1;
  const auto cut = [&](double from, double to, double limit) {
    const auto clip = [&](double p, double q) {  // keeps where p t <= q
      if (p < 0) begin = std::max(begin, q / p);
      if (p > 0) end = std::min(end, q / p);
      if (p == 0 && q < 0) end = -1;
    };
    clip(from - to, from);
    clip(to - from, limit - from);
  };
  cut(a.x, b.x, image.width);
  cut(a.y, b.y, image.height);
  if (!(begin <= end)) return;
  const double long_side = std::max(std::abs(b.x - a.x), std::abs(b.y - a.y)) * (end - begin);
  const int steps = std::max(1, static_cast<int>(std::ceil(long_side)));
  for (int i = 0; i <= steps; ++i) {
    const double t = begin + (end - begin) * i / steps;
    const int x = static_cast<int>(std::floor(a.x + t * (b.x - a.x))),
              y = static_cast<int>(std::floor(a.y + t * (b.y - a.y)));
    blend(image, x, y, color, share(x, y, t));
  }
}

}  // namespace penumbra
