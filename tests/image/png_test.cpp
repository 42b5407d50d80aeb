#include <gtest/gtest.h>
#include <png.h>

#include <random>

#include "core/error.h"
#include "image/image.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

using test::message_of;
using test::TemporaryFolder;

Rgb8Image random_image(int width, int height) {
  std::mt19937 random(11);
  Rgb8Image image{width, height, std::vector<uint8_t>(static_cast<std::size_t>(3 * width * height))};
  for (uint8_t& v : image.rgb) v = static_cast<uint8_t>(random());
  return image;
}

// A file as other programs write them: 8 or 16 bits, gray or colour, with or without alpha.
void write_foreign(const std::filesystem::path& path, png_uint_32 format, int width, int height,
                   const void* pixels) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width), png.height = static_cast<png_uint_32>(height),
  png.format = format;
  ASSERT_TRUE(png_image_write_to_file(&png, path.c_str(), 0, pixels, 0, nullptr)) << png.message;
}

TEST(Png, ReturnsByteForByteAtOddSizes) {
  TemporaryFolder folder;
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(7, 3), std::pair(1, 19), std::pair(4096, 2)}) {
    const Rgb8Image image = random_image(width, height);
    write_png(folder / "a.png", image);
    const Rgb8Image back = read_png(folder / "a.png");
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.rgb, image.rgb) << width << " x " << height;
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"});
}

TEST(Png, TheSameImageGivesTheSameFile) {
  TemporaryFolder folder;
  write_png(folder / "a.png", random_image(33, 21));
  write_png(folder / "b.png", random_image(33, 21));
  EXPECT_EQ(test::file_bytes(folder / "a.png"), test::file_bytes(folder / "b.png"));
}

TEST(Png, GrayIsExpandedAndTransparencyLaidOverBlack) {
  TemporaryFolder folder;
  const std::vector<uint8_t> gray = {0, 100, 255};
  write_foreign(folder / "g.png", PNG_FORMAT_GRAY, 3, 1, gray.data());
  EXPECT_EQ(read_png(folder / "g.png").rgb, (std::vector<uint8_t>{0, 0, 0, 100, 100, 100, 255, 255, 255}));
  const std::vector<uint8_t> rgba = {10, 20, 30, 255, 200, 200, 200, 0};
  write_foreign(folder / "a.png", PNG_FORMAT_RGBA, 2, 1, rgba.data());
  EXPECT_EQ(read_png(folder / "a.png").rgb, (std::vector<uint8_t>{10, 20, 30, 0, 0, 0}));
}

TEST(Png, TruncatedFilesAreInputErrors) {
  TemporaryFolder folder;
  write_png(folder / "whole.png", random_image(40, 40));
  const std::vector<char> whole = test::file_bytes(folder / "whole.png");
  for (std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{20}, std::size_t{40}, whole.size() / 2,
                           whole.size() - 100}) {
    test::write_bytes(folder / "cut.png", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    const std::string message = message_of<InputError>([&] { read_png(folder / "cut.png"); });
    EXPECT_NE(message.find("cut.png"), std::string::npos) << size << ": " << message;
  }
}

TEST(Png, DamagedFilesAreReadOrRefusedButNeverCrash) {
  TemporaryFolder folder;
  write_png(folder / "whole.png", random_image(16, 16));
  const std::vector<char> whole = test::file_bytes(folder / "whole.png");
  std::mt19937 random(13);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<char> bytes = whole;
    bytes[random() % bytes.size()] = static_cast<char>(random());
    test::write_bytes(folder / "bad.png", bytes);
    try {
      read_png(folder / "bad.png");
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
}

TEST(Png, MissingFileFolderAndForeignFileAreNamed) {
  TemporaryFolder folder;
  EXPECT_NE(message_of<InputError>([&] { read_png(folder / "none.png"); }).find("none.png: no such file"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { read_png(folder.path()); }).find("is a directory"),
            std::string::npos);
  test::write_bytes(folder / "text.png", std::vector<char>(100, 'x'));
  EXPECT_NE(message_of<InputError>([&] { read_png(folder / "text.png"); }).find("cannot be read as a PNG"),
            std::string::npos);
}

}  // namespace
}  // namespace penumbra
