#include "metrics/compare_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "image/image.h"
#include "metrics/metrics.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

using test::message_of;
using test::TemporaryFolder;

std::vector<float> ramp(int n, float scale) {
  std::vector<float> v;
  for (int i = 0; i < n; ++i) v.push_back(scale * static_cast<float>(i) / static_cast<float>(n));
  return v;
}

TEST(CompareFiles, GrayFilesAreComparedInTheirChannel) {
  TemporaryFolder folder;
  write_exr_gray(folder / "a.exr", 2, 2, std::vector<float>{0, 1, 0.5f, 0.25f});
  write_exr_gray(folder / "b.exr", 2, 2, std::vector<float>{0.5f, 0.5f, 0.5f, 0.5f});
  const FileComparison c = compare_files(folder / "a.exr", folder / "b.exr");
  EXPECT_FALSE(c.color);
  EXPECT_EQ(c.width, 2);
  EXPECT_EQ(c.mae, 1.25 / 4);
  EXPECT_EQ(c.rmse, std::sqrt(0.5625 / 4));
  EXPECT_EQ(c.max, 0.5);
  EXPECT_NEAR(c.psnr.value(), 8.519374645445622, 1e-12);
}

TEST(CompareFiles, ColorErrorsAreOverAllChannelsAndSsimIsOfTheLuminance) {
  TemporaryFolder folder;
  const std::vector<Vec3f> a = {{0.5f, 0.5f, 0.5f}, {1, 0, 0}}, b = {{0.5f, 0.25f, 0.5f}, {1, 0, 0.5f}};
  write_exr_vectors(folder / "a.exr", 2, 1, a, {"R", "G", "B"});
  write_exr_vectors(folder / "b.exr", 2, 1, b, {"R", "G", "B"});
  const FileComparison c = compare_files(folder / "a.exr", folder / "b.exr");
  EXPECT_TRUE(c.color);
  EXPECT_EQ(c.mae, 0.75 / 6);
  EXPECT_EQ(c.rmse, std::sqrt(0.3125 / 6));
  EXPECT_EQ(c.max, 0.5);
  const std::vector<float> ya = {0.5f, 0.2126f}, yb = {0.5f - 0.25f * 0.7152f, 0.2126f + 0.5f * 0.0722f};
  EXPECT_NEAR(c.ssim, ssim({2, 1, ya, {}}, {2, 1, yb, {}}).value(), 1e-6);
  EXPECT_EQ(c.flip, flip(a, b, 2, 1).mean);
}

TEST(CompareFiles, EqualFilesHaveNoPsnrAndJsonSaysNull) {
  TemporaryFolder folder;
  write_exr_gray(folder / "a.exr", 7, 3, ramp(21, 1));
  const FileComparison c = compare_files(folder / "a.exr", folder / "a.exr");
  EXPECT_EQ(c.mae, 0);
  EXPECT_EQ(c.ssim, 1);
  EXPECT_EQ(c.flip, 0);
  EXPECT_FALSE(c.psnr.has_value());
  const nlohmann::json j = nlohmann::json::parse(to_json(c));
  EXPECT_TRUE(j.at("psnr").is_null());
  EXPECT_EQ(j.at("width"), 7);
  EXPECT_EQ(j.at("ssim"), 1.0);
  EXPECT_EQ(j.at("reference"), (folder / "a.exr").string());
}

TEST(CompareFiles, JsonNeverHoldsNanOrInfinity) {
  FileComparison c;
  c.mae = NAN, c.rmse = INFINITY, c.psnr = -INFINITY, c.flip = NAN;
  c.reference = "not \xff UTF-8";
  const nlohmann::json j = nlohmann::json::parse(to_json(c));
  for (const char* key : {"mae", "rmse", "psnr", "flip"}) EXPECT_TRUE(j.at(key).is_null()) << key;
  EXPECT_EQ(j.at("max"), 0.0);
}

TEST(CompareFiles, PngIsDecodedToLinearLightAndMayMeetExr) {
  TemporaryFolder folder;
  write_png(folder / "a.png", {2, 1, {188, 188, 188, 255, 255, 255}});
  write_exr_gray(folder / "b.exr", 2, 1, std::vector<float>{linear_from_srgb(188), 1});
  const FileComparison c = compare_files(folder / "a.png", folder / "b.exr");
  EXPECT_FALSE(c.color);
  EXPECT_EQ(c.mae, 0);
  write_png(folder / "c.png", {2, 1, {188, 188, 188, 255, 255, 0}});
  EXPECT_TRUE(compare_files(folder / "c.png", folder / "b.exr").color);
  EXPECT_NEAR(compare_files(folder / "c.png", folder / "b.exr").mae, 1.0 / 6, 1e-12);
}

TEST(CompareFiles, LayersAlphaAndASingleOddChannelAreUnderstood) {
  TemporaryFolder folder;
  const std::vector<float> r = ramp(6, 1), g = ramp(6, 0.5f), b = ramp(6, 0.25f), one(6, 1);
  write_exr(folder / "plain.exr", {3, 2, {{"R", r}, {"G", g}, {"B", b}}, {}});
  write_exr(folder / "layer.exr", {3,
                                   2,
                                   {{"View.Combined.R", r},
                                    {"View.Combined.G", g},
                                    {"View.Combined.B", b},
                                    {"View.Combined.A", one},
                                    {"View.Depth.Z", one}},
                                   {}});
  EXPECT_EQ(compare_files(folder / "plain.exr", folder / "layer.exr").mae, 0);
  write_exr(folder / "odd.exr", {3, 2, {{"V", r}}, {}});
  write_exr_gray(folder / "gray.exr", 3, 2, r);
  EXPECT_EQ(compare_files(folder / "odd.exr", folder / "gray.exr").mae, 0);
}

TEST(CompareFiles, FilesWithoutAPictureAreRefusedWithTheirChannels) {
  TemporaryFolder folder;
  write_exr(folder / "mask.exr", {1, 1, {}, {{"w0", {1}}, {"w1", {2}}}});
  const std::string message =
      message_of<InputError>([&] { compare_files(folder / "mask.exr", folder / "mask.exr"); });
  EXPECT_NE(message.find("mask.exr"), std::string::npos) << message;
  EXPECT_NE(message.find("w0 (uint), w1 (uint)"), std::string::npos) << message;
  write_exr(folder / "two.exr", {1, 1, {{"U", {1}}, {"V", {2}}}, {}});
  EXPECT_NE(
      message_of<InputError>([&] { compare_files(folder / "two.exr", folder / "two.exr"); }).find("U, V"),
      std::string::npos);
}

TEST(CompareFiles, DifferentSizesNameBothFilesAndSizes) {
  TemporaryFolder folder;
  write_exr_gray(folder / "small.exr", 3, 2, ramp(6, 1));
  write_png(folder / "large.png", {4, 4, std::vector<uint8_t>(48)});
  const std::string message =
      message_of<InputError>([&] { compare_files(folder / "small.exr", folder / "large.png"); });
  for (const char* part : {"small.exr is 3 x 2", "large.png is 4 x 4"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(CompareFiles, AValueThatIsNotFiniteIsNamedWithFileChannelAndPixel) {
  TemporaryFolder folder;
  write_exr(folder / "a.exr", {2, 2, {{"R", {0, 0, 0, 0}}, {"G", {0, 0, 0, NAN}}, {"B", {0, 0, 0, 0}}}, {}});
  const std::string message =
      message_of<InputError>([&] { compare_files(folder / "a.exr", folder / "a.exr"); });
  EXPECT_NE(message.find("a.exr: channel 'G' has the value nan at pixel (1, 1)"), std::string::npos)
      << message;
}

TEST(CompareFiles, MissingForeignAndEmptyFilesAndFoldersAreNamed) {
  TemporaryFolder folder;
  write_exr_gray(folder / "a.exr", 1, 1, std::vector<float>{1});
  test::write_bytes(folder / "empty.png", {});
  test::write_bytes(folder / "text.exr", {'t', 'e', 'x', 't', '\n'});
  for (const char* name : {"none.exr", "empty.png", "text.exr", "."}) {
    const std::string path = (folder / name).string();
    EXPECT_EQ(message_of<InputError>([&] { compare_files(folder / "a.exr", path); }).find(path), 0u) << name;
    EXPECT_EQ(message_of<InputError>([&] { compare_files(path, folder / "a.exr"); }).find(path), 0u) << name;
  }
}

}  // namespace
}  // namespace penumbra
