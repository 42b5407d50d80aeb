// Drawing for people's eyes: figures as colours, classes as colours, lines. All colours are sRGB-encoded.
#pragma once
#include <array>
#include <functional>

#include "image/image.h"

namespace penumbra {

using Rgb8 = std::array<uint8_t, 3>;

// t in [0, 1], clamped: dark violet through red and orange to pale yellow, ever brighter, so that it can be
// read in grey as well and by people who see few colours. The same as the report's scale beside it.
Rgb8 false_color(double t);
// The colours that false_color() passes through at equal steps, from t = 0 to t = 1.
const std::vector<Rgb8>& false_color_stops();
// Well apart from each other [Okabe & Ito 2008]; `index` modulo their number.
Rgb8 class_color(std::size_t index);
std::string hex(Rgb8 color);  // "#1a2b3c"

// `share` of `over` on a pixel.
void blend(Rgb8Image& image, int x, int y, Rgb8 over, double share);

// How much of a line's colour a pixel takes, from 0 to 1: told the pixel and the place along the line, 0 at
// its beginning and 1 at its end.
using LineShare = std::function<double(int x, int y, double along)>;
// A line one pixel wide from a to b, pixel centres at +0.5; what lies outside of the picture is left out.
void draw_line(Rgb8Image& image, Vec2d a, Vec2d b, Rgb8 color, const LineShare& share);

}  // namespace penumbra
