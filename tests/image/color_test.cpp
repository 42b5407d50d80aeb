#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/image.h"

namespace penumbra {
namespace {

// IEC 61966-2-1, straight from the standard and in double.
double encode(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

TEST(Srgb, EveryCodeSurvivesTheRoundTrip) {
  for (int i = 0; i < 256; ++i) EXPECT_EQ(srgb_from_linear(linear_from_srgb(static_cast<uint8_t>(i))), i);
}

TEST(Srgb, RoundsToTheNearestCode) {
  for (int i = 0; i <= 200000; ++i) {
    const float v = static_cast<float>(i) / 200000.0f;
    const double exact = 255 * encode(static_cast<double>(v));
    // A value within 1e-4 of a border may go either way: the standard's two halves meet only to that.
    if (std::abs(exact - std::floor(exact) - 0.5) < 1e-4) continue;
    ASSERT_EQ(srgb_from_linear(v), std::lround(exact)) << "at " << v;
  }
}

TEST(Srgb, KnownValues) {
  EXPECT_EQ(srgb_from_linear(0.0f), 0);
  EXPECT_EQ(srgb_from_linear(1.0f), 255);
  EXPECT_EQ(srgb_from_linear(0.5f), 188);
  EXPECT_EQ(srgb_from_linear(0.18f), 118);
  EXPECT_NEAR(linear_from_srgb(128), 0.215861, 1e-6);
}

TEST(Srgb, ValuesOutsideTheRangeAreClamped) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (float v : {-1.0f, -infinity, std::nanf("")}) EXPECT_EQ(srgb_from_linear(v), 0) << v;
  for (float v : {1.001f, 1e30f, infinity}) EXPECT_EQ(srgb_from_linear(v), 255) << v;
}

TEST(Tonemap, EncodesEachChannelAndShowsNanAsMagenta) {
  const std::vector<Vec3f> linear = {{0.0f, 0.5f, 1.0f}, {0.5f, std::nanf(""), 0.0f}};
  const Rgb8Image image = tonemap(linear, 2, 1);
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 1);
  EXPECT_EQ(image.rgb, (std::vector<uint8_t>{0, 188, 255, 255, 0, 255}));
}

}  // namespace
}  // namespace penumbra
