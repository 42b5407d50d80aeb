// The comparison itself: it must see every pixel beyond the bound.
#include "tests/support/golden.h"

#include <cstdlib>

#include "tests/support/temporary_folder.h"

namespace penumbra::test {
namespace {

Rgb8Image gradient() {
  Rgb8Image image{16, 8, {}};
  for (int i = 0; i < 16 * 8; ++i)
    for (int c = 0; c < 3; ++c) image.rgb.push_back(static_cast<uint8_t>(i + 40 * c));
  return image;
}

TEST(Golden, AnEqualPictureMatches) {
  TemporaryFolder folder;
  write_png(folder / "g.png", gradient());
  EXPECT_TRUE(matches_golden(gradient(), folder / "g.png", {}, folder.path()));
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(Golden, OneCodeOfOnePixelIsSeenAndNamed) {
  TemporaryFolder folder;
  write_png(folder / "g.png", gradient());
  Rgb8Image picture = gradient();
  picture.rgb[3 * (5 * 16 + 7) + 1] += 3;
  const testing::AssertionResult exact = matches_golden(picture, folder / "g.png", {}, folder.path());
  EXPECT_FALSE(exact);
  EXPECT_NE(std::string(exact.message()).find("1 of 128 pixels"), std::string::npos) << exact.message();
  EXPECT_NE(std::string(exact.message()).find("(7, 5) by 3"), std::string::npos) << exact.message();
  EXPECT_EQ(read_png(folder / "g.found.png").rgb, picture.rgb);
  EXPECT_EQ(read_png(folder / "g.difference.png").rgb[3 * (5 * 16 + 7)], 255);
  EXPECT_FALSE(matches_golden(picture, folder / "g.png", {2, 0}, folder.path()));
  EXPECT_TRUE(matches_golden(picture, folder / "g.png", {3, 0}, folder.path()));
}

TEST(Golden, TheShareBeyondTheBoundIsAShareOfPixels) {
  TemporaryFolder folder;
  write_png(folder / "g.png", gradient());
  Rgb8Image picture = gradient();
  for (std::size_t i = 0; i < 4; ++i) picture.rgb[30 * i] = 255;
  EXPECT_TRUE(matches_golden(picture, folder / "g.png", {0, 4.0 / 128}, folder.path()));
  EXPECT_FALSE(matches_golden(picture, folder / "g.png", {0, 3.9 / 128}, folder.path()));
}

TEST(Golden, AMissingOrOtherSizedGoldenImageFails) {
  TemporaryFolder folder;
  EXPECT_FALSE(matches_golden(gradient(), folder / "none.png", {}, folder.path()));
  write_png(folder / "small.png", {1, 1, {0, 0, 0}});
  EXPECT_FALSE(matches_golden(gradient(), folder / "small.png", {255, 1}, folder.path()));
}

TEST(Golden, RenewingWritesThePictureAndFails) {
  TemporaryFolder folder;
  const char* before = std::getenv("PENUMBRA_RENEW_GOLDEN");
  const std::string kept = before ? before : "";
  ::setenv("PENUMBRA_RENEW_GOLDEN", "1", 1);
  const testing::AssertionResult result = matches_golden(gradient(), folder / "new/g.png", {}, folder.path());
  if (before)
    ::setenv("PENUMBRA_RENEW_GOLDEN", kept.c_str(), 1);
  else
    ::unsetenv("PENUMBRA_RENEW_GOLDEN");
  EXPECT_FALSE(result);
  EXPECT_EQ(read_png(folder / "new/g.png").rgb, gradient().rgb);
}

}  // namespace
}  // namespace penumbra::test
