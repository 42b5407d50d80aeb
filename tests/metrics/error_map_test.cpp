#include "metrics/error_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

using Color = std::array<uint8_t, 3>;

void expect_near(const Color& found, const Color& expected) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1) << "component " << i;
}

TEST(DivergingColor, EndsAndMiddleAreThePublishedOnes) {
  expect_near(diverging_color(-1), {59, 76, 192});
  expect_near(diverging_color(0), {221, 221, 221});
  expect_near(diverging_color(1), {180, 4, 38});
}

TEST(DivergingColor, IsClampedAndShowsNan) {
  EXPECT_EQ(diverging_color(-7), diverging_color(-1));
  EXPECT_EQ(diverging_color(INFINITY), diverging_color(1));
  EXPECT_EQ(diverging_color(NAN), (Color{255, 0, 255}));
}

TEST(DivergingColor, BlueIsNegativeRedIsPositiveAndBothDarkenOutwards) {
  int last_blue = 1000, last_red = 1000;
  for (int i = 1; i <= 16; ++i) {
    const Color blue = diverging_color(-i / 16.0), red = diverging_color(i / 16.0);
    EXPECT_GT(blue[2], blue[0]);
    EXPECT_GT(red[0], red[2]);
    EXPECT_LT(blue[0] + blue[1] + blue[2], last_blue);
    EXPECT_LT(red[0] + red[1] + red[2], last_red);
    last_blue = blue[0] + blue[1] + blue[2], last_red = red[0] + red[1] + red[2];
  }
}

TEST(ErrorMap, ShowsSignScaleAndWhatDoesNotCount) {
  const std::vector<float> reference = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f},
                           test = {0.5f, 0.25f, 0.75f, 0.625f, std::nanf(""), 0};
  const std::vector<uint8_t> evaluated = {1, 1, 1, 1, 1, 0};
  const Rgb8Image map = error_map({3, 2, reference, evaluated}, {3, 2, test, {}}, 0.25);
  const auto pixel = [&](std::size_t i) {
    return Color{map.rgb[3 * i], map.rgb[3 * i + 1], map.rgb[3 * i + 2]};
  };
  ASSERT_EQ(map.rgb.size(), 18u);
  EXPECT_EQ(pixel(0), diverging_color(0));
  EXPECT_EQ(pixel(1), diverging_color(-1));
  EXPECT_EQ(pixel(2), diverging_color(1));
  EXPECT_EQ(pixel(3), diverging_color(0.5));
  EXPECT_EQ(pixel(4), (Color{255, 0, 255}));
  EXPECT_EQ(pixel(5), (Color{64, 64, 64}));
}

TEST(ErrorMap, BadScalesAndSizesAreRefused) {
  const std::vector<float> six(6);
  for (double scale : {0.0, -1.0, double(NAN), double(INFINITY)})
    test::message_of<InputError>([&] { error_map({3, 2, six, {}}, {3, 2, six, {}}, scale); });
  test::message_of<InputError>([&] { error_map({3, 2, six, {}}, {2, 3, six, {}}, 1); });
}

TEST(ErrorMap, TheColorBarRunsFromEndToEnd) {
  const Rgb8Image bar = error_color_bar(101, 2);
  ASSERT_EQ(bar.rgb.size(), 606u);
  const auto pixel = [&](std::size_t i) {
    return Color{bar.rgb[3 * i], bar.rgb[3 * i + 1], bar.rgb[3 * i + 2]};
  };
  EXPECT_EQ(pixel(0), diverging_color(-1));
  EXPECT_EQ(pixel(50), diverging_color(0));
  EXPECT_EQ(pixel(201), diverging_color(1));
}

}  // namespace
}  // namespace penumbra
