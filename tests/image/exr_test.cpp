#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "core/error.h"
#include "image/image.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

using test::message_of;
using test::TemporaryFolder;

std::vector<float> random_floats(std::size_t n, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> v(n);
  for (float& f : v)
    f = std::bit_cast<float>(static_cast<uint32_t>(random()) &
                             0xbfffffffU);  // any finite bits of magnitude below 2
  return v;
}

std::vector<uint32_t> random_words(std::size_t n, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<uint32_t> v(n);
  for (uint32_t& w : v) w = static_cast<uint32_t>(random());
  return v;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) {
           return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y);
         });
}

class ExrSizes : public testing::TestWithParam<std::pair<int, int>> {};
INSTANTIATE_TEST_SUITE_P(Odd, ExrSizes,
                         testing::Values(std::pair(1, 1), std::pair(7, 3), std::pair(1, 37),
                                         std::pair(4096, 5), std::pair(257, 129)));

TEST_P(ExrSizes, FloatAndUintChannelsReturnBitForBit) {
  const auto [width, height] = GetParam();
  const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  TemporaryFolder folder;
  ExrImage image{width, height, {}, {}};
  image.floats = {{"Z", random_floats(n, 1)}, {"A", random_floats(n, 2)}};
  image.uints = {{"w0", random_words(n, 3)}, {"w1", random_words(n, 4)}};
  write_exr(folder / "a.exr", image);
  const ExrImage back = read_exr(folder / "a.exr");
  EXPECT_EQ(back.width, width);
  EXPECT_EQ(back.height, height);
  ASSERT_EQ(back.floats.size(), 2u);
  ASSERT_EQ(back.uints.size(), 2u);
  for (const FloatChannel& c : image.floats) {
    ASSERT_NE(back.find(c.name), nullptr) << c.name;
    EXPECT_TRUE(same_bits(back.find(c.name)->values, c.values)) << c.name;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.uints[i].name, image.uints[i].name);
    EXPECT_EQ(back.uints[i].values, image.uints[i].values);
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.exr"});
}

TEST(Exr, GrayIsOneFloatChannelYWithRowZeroOnTop) {
  TemporaryFolder folder;
  const std::vector<float> values = {1, 2, 3, 4, 5, 6};
  write_exr_gray(folder / "g.exr", 3, 2, values);
  const ExrImage back = read_exr(folder / "g.exr");
  ASSERT_EQ(back.floats.size(), 1u);
  EXPECT_EQ(back.floats[0].name, "Y");
  EXPECT_EQ(back.floats[0].values, values);
  // The library's own reader of colours agrees on which row is on top.
  Imf::RgbaInputFile file((folder / "g.exr").c_str());
  Imf::Array2D<Imf::Rgba> pixels(2, 3);
  file.setFrameBuffer(&pixels[0][0], 1, 3);
  file.readPixels(0, 1);
  EXPECT_EQ(float(pixels[0][1].r), 2.0f);
  EXPECT_EQ(float(pixels[1][0].r), 4.0f);
}

TEST(Exr, VectorsAndWordsAreTakenApartIntoChannels) {
  TemporaryFolder folder;
  const std::vector<Vec3f> three = {{1, 2, 3}, {4, 5, 6}};
  const std::vector<Vec4f> four = {{1, 2, 3, 9}, {4, 5, 6, 9}};
  write_exr_vectors(folder / "3.exr", 2, 1, three, {"R", "G", "B"});
  write_exr_vectors(folder / "4.exr", 2, 1, four, {"X", "Y", "Z"});
  write_exr_words(folder / "w.exr", 2, 1, std::vector<uint32_t>{10, 20, 30, 40, 50, 60}, {"w0", "w1", "w2"});
  EXPECT_EQ(read_exr(folder / "3.exr").find("R")->values, (std::vector<float>{1, 4}));
  EXPECT_EQ(read_exr(folder / "3.exr").find("B")->values, (std::vector<float>{3, 6}));
  EXPECT_EQ(read_exr(folder / "4.exr").find("Z")->values, (std::vector<float>{3, 6}));
  EXPECT_EQ(read_exr(folder / "4.exr").floats.size(), 3u);
  const ExrImage words = read_exr(folder / "w.exr");
  ASSERT_EQ(words.uints.size(), 3u);
  EXPECT_EQ(words.uints[2].name, "w2");
  EXPECT_EQ(words.uints[2].values, (std::vector<uint32_t>{30, 60}));
}

TEST(Exr, NotANumberAndInfinitySurvive) {
  TemporaryFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  write_exr_gray(folder / "n.exr", 3, 1, std::vector<float>{std::nanf(""), infinity, -infinity});
  const std::vector<float> back = read_exr(folder / "n.exr").floats.at(0).values;
  EXPECT_TRUE(std::isnan(back[0]));
  EXPECT_EQ(back[1], infinity);
  EXPECT_EQ(back[2], -infinity);
}

TEST(Exr, HalfFilesAreWidened) {
  TemporaryFolder folder;
  std::vector<Imf::Rgba> pixels;
  for (int i = 0; i < 6; ++i) pixels.emplace_back(0.1f * float(i), float(i), 1000.0f, 1.0f);
  {
    Imf::RgbaOutputFile out((folder / "h.exr").c_str(), 3, 2, Imf::WRITE_RGBA);
    out.setFrameBuffer(pixels.data(), 1, 3);
    out.writePixels(2);
  }
  const ExrImage back = read_exr(folder / "h.exr");
  EXPECT_EQ(back.width, 3);
  EXPECT_EQ(back.height, 2);
  ASSERT_EQ(back.floats.size(), 4u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(back.find("R")->values[i], float(pixels[i].r));
    EXPECT_EQ(back.find("G")->values[i], float(i));
  }
}

TEST(Exr, TiledFilesAndShiftedDataWindowsAreRead) {
  TemporaryFolder folder;
  const int width = 50, height = 33;
  std::vector<float> values(static_cast<std::size_t>(width * height));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), Imath::Box2i({-5, 7}, {-5 + width - 1, 7 + height - 1}));
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.setTileDescription(Imf::TileDescription(16, 16));
  {
    Imf::TiledOutputFile out((folder / "t.exr").c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow(), sizeof(float)));
    out.setFrameBuffer(frame);
    out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
  }
  const ExrImage back = read_exr(folder / "t.exr");
  EXPECT_EQ(back.width, width);
  EXPECT_EQ(back.height, height);
  EXPECT_EQ(back.find("Y")->values, values);
}

TEST(Exr, TruncatedFilesAreInputErrorsAtEveryLength) {
  TemporaryFolder folder;
  write_exr_gray(folder / "whole.exr", 64, 64, random_floats(64 * 64, 5));
  const std::vector<char> whole = test::file_bytes(folder / "whole.exr");
  for (std::size_t size : {std::size_t{0}, std::size_t{3}, std::size_t{4}, std::size_t{60}, std::size_t{300},
                           whole.size() / 2, whole.size() - 1}) {
    test::write_bytes(folder / "cut.exr", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    const std::string message = message_of<InputError>([&] { read_exr(folder / "cut.exr"); });
    EXPECT_NE(message.find("cut.exr"), std::string::npos) << size << ": " << message;
  }
}

TEST(Exr, DamagedFilesAreReadOrRefusedButNeverCrash) {
  TemporaryFolder folder;
  write_exr_gray(folder / "whole.exr", 20, 20, random_floats(400, 6));
  const std::vector<char> whole = test::file_bytes(folder / "whole.exr");
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<char> bytes = whole;
    // The header's part is hit as often as the pixels'.
    const std::size_t range = i % 2 ? 400 : bytes.size();
    bytes[random() % range] = static_cast<char>(random());
    test::write_bytes(folder / "bad.exr", bytes);
    try {
      read_exr(folder / "bad.exr");
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
}

TEST(Exr, MissingFileFolderAndForeignFileAreNamed) {
  TemporaryFolder folder;
  EXPECT_NE(message_of<InputError>([&] { read_exr(folder / "none.exr"); }).find("none.exr: no such file"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { read_exr(folder.path()); }).find("is a directory"),
            std::string::npos);
  test::write_bytes(folder / "text.exr", {'h', 'e', 'l', 'l', 'o', ' ', 'w', 'o', 'r', 'l', 'd'});
  EXPECT_NE(
      message_of<InputError>([&] { read_exr(folder / "text.exr"); }).find("cannot be read as an OpenEXR"),
      std::string::npos);
}

}  // namespace
}  // namespace penumbra
