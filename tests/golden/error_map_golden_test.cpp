#include <algorithm>
#include <cmath>

#include "metrics/error_map.h"
#include "tests/support/golden.h"

namespace penumbra {
namespace {

// Bound 1: the colours come from powers and cosines, whose last bit differs between C libraries.
constexpr test::GoldenBound one_code{1, 0};

TEST(ErrorMapGolden, TheColorBarLooksAsBefore) {
  EXPECT_TRUE(test::matches_golden(error_color_bar(257, 16), "tests/golden/error_color_bar.png", one_code));
}

// A penumbra that is too wide on one side and too narrow on the other, outside of which nothing is evaluated.
TEST(ErrorMapGolden, AShiftedPenumbraIsBlueBesideRed) {
  const int width = 96, height = 64;
  std::vector<float> reference, found;
  std::vector<uint8_t> evaluated;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float d = std::sqrt(static_cast<float>((x - 48) * (x - 48) + (y - 32) * (y - 32)));
      reference.push_back(std::clamp((d - 12) / 12, 0.0f, 1.0f));
      const float shifted = std::sqrt(static_cast<float>((x - 52) * (x - 52) + (y - 32) * (y - 32)));
      found.push_back(std::clamp((shifted - 12) / 12, 0.0f, 1.0f));
      evaluated.push_back(d < 40);
    }
  const Rgb8Image map = error_map({width, height, reference, evaluated}, {width, height, found, {}}, 0.5);
  EXPECT_TRUE(test::matches_golden(map, "tests/golden/error_map_shifted.png", one_code));
}

}  // namespace
}  // namespace penumbra
