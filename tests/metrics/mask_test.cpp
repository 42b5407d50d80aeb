#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "metrics/metrics.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

TEST(MaskMismatch, CountsBitsAndPixels) {
  const std::vector<uint32_t> reference = {0x0, 0xff, 0xffffffff}, test = {0x1, 0xff, 0x0};
  const MaskMismatch m = mask_mismatch(reference, test, 1, 32, {});
  EXPECT_EQ(m.bits_off, 33u);
  EXPECT_EQ(m.bits, 96u);
  EXPECT_EQ(m.pixels_off, 2u);
  EXPECT_EQ(m.pixels, 3u);
  EXPECT_EQ(m.mask_bit_mismatch(), 33.0 / 96);
}

TEST(MaskMismatch, BitsPastTheLastLightSampleDoNotCount) {
  const std::vector<uint32_t> reference = {0, 0}, test = {0, 0xfffffffe};
  EXPECT_EQ(mask_mismatch(reference, test, 2, 33, {}).bits_off, 0u);
  EXPECT_EQ(mask_mismatch(reference, test, 2, 34, {}).bits_off, 1u);
  EXPECT_EQ(mask_mismatch(reference, test, 2, 64, {}).bits_off, 31u);
  EXPECT_EQ(mask_mismatch(reference, test, 2, 33, {}).bits, 33u);
}

TEST(MaskMismatch, OnlyEvaluatedPixelsCount) {
  const std::vector<uint32_t> reference = {0, 0, 0}, test = {1, 1, 0};
  const MaskMismatch m = mask_mismatch(reference, test, 1, 1, std::vector<uint8_t>{0, 1, 1});
  EXPECT_EQ(m.bits_off, 1u);
  EXPECT_EQ(m.bits, 2u);
  EXPECT_EQ(m.pixels, 2u);
}

TEST(MaskMismatch, NothingComparedIsNoMismatch) {
  EXPECT_EQ(mask_mismatch({}, {}, 1, 1, {}).mask_bit_mismatch(), 0.0);
}

TEST(MaskMismatch, AgreesWithCountingBitByBit) {
  constexpr int samples = 256 + 5, words = 9, pixels = 500;
  std::mt19937 random(5);
  std::vector<uint32_t> a(words * pixels), b(words * pixels);
  std::vector<uint8_t> evaluated(pixels);
  for (std::size_t i = 0; i < a.size(); ++i)
    a[i] = static_cast<uint32_t>(random()), b[i] = i % 3 ? a[i] : static_cast<uint32_t>(random());
  for (uint8_t& e : evaluated) e = random() % 4 != 0;
  uint64_t bits_off = 0;
  for (std::size_t p = 0; p < pixels; ++p)
    for (std::size_t s = 0; evaluated[p] && s < samples; ++s)
      bits_off += ((a[p * words + s / 32] >> s % 32) & 1) != ((b[p * words + s / 32] >> s % 32) & 1);
  EXPECT_EQ(mask_mismatch(a, b, words, samples, evaluated).bits_off, bits_off);
}

TEST(MaskMismatch, ArraysThatDoNotFitAreRefused) {
  const std::vector<uint32_t> three(3), four(4);
  test::message_of<InputError>([&] { mask_mismatch(three, four, 1, 32, {}); });
  test::message_of<InputError>([&] { mask_mismatch(three, three, 2, 64, {}); });
  test::message_of<InputError>([&] { mask_mismatch(four, four, 2, 32, {}); });
  test::message_of<InputError>([&] { mask_mismatch(four, four, 2, 64, std::vector<uint8_t>(3)); });
  test::message_of<InputError>([&] { mask_mismatch(four, four, 0, 0, {}); });
}

}  // namespace
}  // namespace penumbra
