// Diagnostic pictures: colours, and lines that the scene hides.
#include "run/diagnostics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "image/false_color.h"
#include "tests/support/host_view.h"

namespace penumbra::run {
namespace {

using Color = std::array<int, 3>;

Color at(const Rgb8Image& image, int x, int y) {
  const std::size_t i = 3 * static_cast<std::size_t>(y * image.width + x);
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}
bool grey(Color c) { return c[0] == c[1] && c[1] == c[2]; }
int colorfulness(Color c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }

// A square of 2 x 2 in the plane z = 0, seen straight on from z = 4; it fills the middle of the picture.
struct Square {
  Square() {
    testing::add_triangle(geometry, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0});
    testing::add_triangle(geometry, {-1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    camera = testing::camera_at({0, 0, 4}, {0, 0, 0});
    view = testing::see(geometry, camera, 101, 101);
    host = view.host();
    back = backdrop(std::vector<Vec3f>(host.pixel_count(), Vec3f{0.5F, 0.5F, 0.5F}), host, camera);
  }
  Drawn lines(Vec4f a, Vec4f b) const { return draw({"lines", "", WorldLines{{{a, b, 0}}, {"line"}}}, back); }
  Geometry geometry;
  Camera camera;
  testing::HostView view;
  ViewSamplesHost host;
  Backdrop back;
};

TEST(FalseColor, IsEverBrighter) {
  double before = -1;
  for (int i = 0; i <= 100; ++i) {
    const Rgb8 c = false_color(i / 100.0);
    const double bright = 0.2126 * static_cast<double>(linear_from_srgb(c[0])) +
                          0.7152 * static_cast<double>(linear_from_srgb(c[1])) +
                          0.0722 * static_cast<double>(linear_from_srgb(c[2]));
    EXPECT_GT(bright, before) << i;
    before = bright;
  }
  EXPECT_EQ(false_color(-1), false_color(0));
  EXPECT_EQ(false_color(7), false_color(1));
  EXPECT_EQ(hex({0, 18, 255}), "#0012ff");
}

TEST(Diagnostics, ALineBeforeTheSceneIsSeenAndOneBehindItIsFaint) {
  const Square s;
  const Color before = at(s.lines({-3, 0, 1, 1}, {3, 0, 1, 1}).picture, 50, 50);
  const Color behind = at(s.lines({-9, 0, -1, 1}, {9, 0, -1, 1}).picture, 50, 50);
  EXPECT_GT(colorfulness(before), 100);
  EXPECT_GT(colorfulness(behind), 5);
  EXPECT_LT(colorfulness(behind), 50);
  // Beside the square nothing hides it.
  EXPECT_GT(colorfulness(at(s.lines({-9, 0, -1, 1}, {9, 0, -1, 1}).picture, 2, 50)), 100);
  EXPECT_TRUE(grey(at(s.lines({-3, 0, 1, 1}, {3, 0, 1, 1}).picture, 50, 40)));
}

TEST(Diagnostics, LinesMayGoToInfinityOrBehindTheCamera) {
  const Square s;
  // From the square's middle to the right, for ever; and from behind the eye into the picture.
  const Rgb8Image right = s.lines({0, 0, 0.1F, 1}, {1, 0, 0, 0}).picture;
  EXPECT_GT(colorfulness(at(right, 100, 50)), 100);
  EXPECT_TRUE(grey(at(right, 40, 50)));
  const Rgb8Image through = s.lines({0.5F, 0, 9, 1}, {0.5F, 0, 0.1F, 1}).picture;
  EXPECT_GT(colorfulness(at(through, 100, 50)), 100);
  const Rgb8Image none = s.lines({0.5F, 0, 9, 1}, {0.5F, 0, 5, 1}).picture;
  EXPECT_EQ(none.rgb, s.back.picture.rgb);
}

TEST(Diagnostics, FiguresAreLogarithmicAndNoneIsLeftGrey) {
  const Square s;
  std::vector<float> values(s.host.pixel_count(), std::nanf(""));
  values[0] = 0, values[1] = 1, values[2] = 99;
  const Drawn d = draw({"n", "title", PixelFigures{values}}, s.back);
  EXPECT_TRUE(grey(at(d.picture, 0, 0)) && grey(at(d.picture, 5, 5)));
  EXPECT_GT(at(d.picture, 2, 0)[0], at(d.picture, 1, 0)[0]);
  EXPECT_EQ(d.legend["high"], 99.0);
  EXPECT_EQ(d.legend["above_none"], 2);
  EXPECT_NEAR(d.legend["marks"][2].get<double>(), 9, 1e-5);  // half way to log(100): log(10)
  EXPECT_EQ(d.figures.size(), values.size());
}

TEST(Diagnostics, PicturesOfAnotherSizeAreRefused) {
  const Square s;
  EXPECT_THROW(draw({"n", "", PixelFigures{std::vector<float>(7)}}, s.back), PointError);
}

TEST(Diagnostics, GridsAreEnlargedAndOutlined) {
  const Square s;
  GridFigures grid{
      8, 8, std::vector<float>(64), {{{1, 1}, {3, 1}, {3, 3}, {1, 3}}}, {{{1, 1}, {3, 3}, {1, 3}}}, "o", "i"};
  grid.values[9] = 5;
  const Drawn d = draw({"g", "", grid}, s.back);
  EXPECT_EQ(d.picture.width, 512);
  EXPECT_EQ(at(d.picture, 500, 500), (Color{0, 0, 0}));
  EXPECT_GT(colorfulness(at(d.picture, 64 + 32, 64 + 20)), 50);
  EXPECT_GT(at(d.picture, 3 * 64, 2 * 64)[0], 200);  // the outline's right side
  EXPECT_EQ(d.legend["names"][1], "i");
}

TEST(Diagnostics, ZonesAreTheMetrics) {
  const std::vector<float> v{0, 0.5F, 1, 1};
  const auto classes = std::get<PixelClasses>(zones(v, std::vector<uint8_t>{1, 1, 1, 0}).content);
  EXPECT_EQ(classes.values, (std::vector<uint8_t>{0, 1, 2, no_class}));
}

}  // namespace
}  // namespace penumbra::run
