#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"
#include "metrics/metrics.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

using test::message_of;

std::vector<float> constant(std::size_t n, float v) { return std::vector<float>(n, v); }

TEST(ImageErrors, AConstantOffsetIsItsOwnMaeRmseMaxAndBias) {
  const std::vector<float> reference = constant(12, 0.75f), test = constant(12, 0.5f);
  const ImageErrors e = image_errors({4, 3, reference, {}}, {4, 3, test, {}});
  EXPECT_EQ(e.mae, 0.25);
  EXPECT_EQ(e.rmse, 0.25);
  EXPECT_EQ(e.max, 0.25);
  EXPECT_EQ(e.bias, -0.25);  // test - reference
  EXPECT_EQ(e.evaluated_pixels, 12u);
  EXPECT_NEAR(e.psnr.value(), 12.0411998265592479, 1e-12);  // 20 log10(4)
}

TEST(ImageErrors, ByHandOnFourPixels) {
  const std::vector<float> reference = {0, 1, 0.5f, 0.25f}, test = {0.5f, 0.5f, 0.5f, 0.5f};
  const ImageErrors e = image_errors({2, 2, reference, {}}, {2, 2, test, {}});
  EXPECT_EQ(e.mae, 1.25 / 4);
  EXPECT_EQ(e.rmse, std::sqrt(0.5625 / 4));
  EXPECT_EQ(e.max, 0.5);
  EXPECT_EQ(e.bias, 0.25 / 4);
  EXPECT_NEAR(e.psnr.value(), 8.519374645445622, 1e-12);  // 10 log10(4 / 0.5625)
}

TEST(ImageErrors, EqualImagesHaveNoPsnr) {
  const std::vector<float> image = {0, 0.3f, 1, 0.7f};
  const ImageErrors e = image_errors({4, 1, image, {}}, {4, 1, image, {}});
  EXPECT_EQ(e.mae, 0.0);
  EXPECT_EQ(e.rmse, 0.0);
  EXPECT_EQ(e.max, 0.0);
  EXPECT_EQ(e.ssim, 1.0);
  EXPECT_FALSE(e.psnr.has_value());
}

TEST(ImageErrors, ZonesFollowTheReferenceAlone) {
  const std::vector<float> reference = {0, 0, 1, 1, 1, 0.5f}, test = {0, 0.5f, 1, 0.75f, 0.5f, 1};
  const ImageErrors e = image_errors({3, 2, reference, {}}, {3, 2, test, {}});
  EXPECT_EQ(e.umbra.pixels, 2u);
  EXPECT_EQ(e.umbra.mae, 0.25);
  EXPECT_EQ(e.umbra.bias, 0.25);
  EXPECT_EQ(e.lit.pixels, 3u);
  EXPECT_EQ(e.lit.mae, 0.25);
  EXPECT_EQ(e.lit.bias, -0.25);
  EXPECT_EQ(e.penumbra.pixels, 1u);
  EXPECT_EQ(e.penumbra.mae, 0.5);
  EXPECT_EQ(e.penumbra.bias, 0.5);
  EXPECT_EQ(e.acne, 2.0 / 3);
  EXPECT_EQ(e.leak, 0.5);
}

TEST(ImageErrors, AcneAndLeaksBeginAboveHalfAStepOf256) {
  const float step = 1.0f / 512;
  const std::vector<float> reference = {1, 1, 0, 0};
  const std::vector<float> at = {1 - step, 1, step, 0}, above = {1 - step - 1e-6f, 1, step + 1e-6f, 0};
  EXPECT_EQ(image_errors({4, 1, reference, {}}, {4, 1, at, {}}).acne, 0.0);
  EXPECT_EQ(image_errors({4, 1, reference, {}}, {4, 1, at, {}}).leak, 0.0);
  EXPECT_EQ(image_errors({4, 1, reference, {}}, {4, 1, above, {}}).acne, 0.5);
  EXPECT_EQ(image_errors({4, 1, reference, {}}, {4, 1, above, {}}).leak, 0.5);
}

TEST(ImageErrors, RatesOfAZoneWithoutPixelsHaveNoValue) {
  const std::vector<float> half = constant(4, 0.5f);
  const ImageErrors e = image_errors({2, 2, half, {}}, {2, 2, half, {}});
  EXPECT_FALSE(e.acne.has_value());
  EXPECT_FALSE(e.leak.has_value());
  EXPECT_EQ(e.umbra.pixels, 0u);
}

TEST(ImageErrors, OnlyPixelsEvaluatedInBothCount) {
  const float nan = std::nanf("");
  const std::vector<float> reference = {0.5f, nan, 0.5f, 0.5f}, test = {0.75f, 0, nan, 0.5f};
  const std::vector<uint8_t> in_reference = {1, 0, 1, 1}, in_test = {1, 1, 0, 1};
  const ImageErrors e = image_errors({2, 2, reference, in_reference}, {2, 2, test, in_test});
  EXPECT_EQ(e.evaluated_pixels, 2u);
  EXPECT_EQ(e.mae, 0.125);
  EXPECT_EQ(e.max, 0.25);
}

TEST(ImageErrors, NothingEvaluatedHasNoValue) {
  const std::vector<float> image = constant(4, 1);
  const std::vector<uint8_t> none(4, 0);
  const ImageErrors e = image_errors({2, 2, image, none}, {2, 2, image, {}});
  EXPECT_EQ(e.evaluated_pixels, 0u);
  for (const auto& metric : {e.mae, e.rmse, e.max, e.psnr, e.ssim, e.bias, e.acne, e.leak})
    EXPECT_FALSE(metric.has_value());
}

TEST(ImageErrors, AValueThatIsNotFiniteIsNamedWithItsPixel) {
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> good = constant(12, 0.5f), bad = good;
  bad[7] = std::nanf("");
  std::string message = message_of<InputError>([&] { image_errors({4, 3, good, {}}, {4, 3, bad, {}}); });
  EXPECT_NE(message.find("test"), std::string::npos) << message;
  EXPECT_NE(message.find("nan at pixel (3, 1)"), std::string::npos) << message;
  bad[7] = -infinity;
  message = message_of<InputError>([&] { image_errors({4, 3, bad, {}}, {4, 3, good, {}}); });
  EXPECT_NE(message.find("reference"), std::string::npos) << message;
  EXPECT_NE(message.find("-inf at pixel (3, 1)"), std::string::npos) << message;
}

TEST(ImageErrors, DifferentSizesAreRefused) {
  const std::vector<float> six = constant(6, 1);
  const std::string message = message_of<InputError>([&] { image_errors({3, 2, six, {}}, {2, 3, six, {}}); });
  EXPECT_NE(message.find("3 x 2"), std::string::npos) << message;
  EXPECT_NE(message.find("2 x 3"), std::string::npos) << message;
  message_of<InputError>([&] { image_errors({3, 3, six, {}}, {3, 3, six, {}}); });
}

TEST(ImageErrors, AMillionSmallErrorsLoseNoDigits) {
  // Float sums would be off in the fourth digit here.
  const int n = 1024;
  std::vector<float> reference = constant(static_cast<std::size_t>(n * n), 0.5f), test = reference;
  for (float& v : test) v += 1.0f / 8192;
  const ImageErrors e = pixel_errors({n, n, reference, {}}, {n, n, test, {}});
  EXPECT_EQ(e.mae, 1.0 / 8192);
  EXPECT_EQ(e.bias, 1.0 / 8192);
  EXPECT_FALSE(e.ssim.has_value());
}

}  // namespace
}  // namespace penumbra
