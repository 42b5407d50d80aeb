// The signed error of visibility as a picture.
#pragma once
#include <array>
#include <cstdint>

#include "image/image.h"
#include "metrics/metrics.h"

namespace penumbra {

// A diverging colour for t in [-1, 1], clamped beyond: blue (negative) by light gray (0) to red (positive),
// equally bright on both sides [Moreland 2009, cool to warm]. sRGB-encoded. NaN is magenta.
std::array<uint8_t, 3> diverging_color(double t);

// test - reference: an error of +-`scale` reaches the ends of the colours, so blue is too dark and red too
// light. Pixels that do not count are dark gray; a pixel that is not finite in either image is magenta.
// Throws InputError when sizes differ or `scale` is not above 0.
Rgb8Image error_map(const ScalarImage& reference, const ScalarImage& test, double scale);

// A colour bar to stand beside it, for `scale` on its right end: `width` x `height` pixels, left = -scale.
Rgb8Image error_color_bar(int width, int height);

}  // namespace penumbra
