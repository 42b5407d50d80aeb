#include "tests/support/golden.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/error.h"

namespace penumbra::test {
namespace {

namespace fs = std::filesystem;

bool renewing() {
  const char* value = std::getenv("PENUMBRA_RENEW_GOLDEN");
  return value && std::string_view(value) == "1";
}

struct Difference {
  std::size_t beyond = 0, pixels = 0;
  int largest = 0, x = 0, y = 0;  // of a channel, and where
  Rgb8Image map;                  // white where the bound is exceeded, else eight times the difference
};

Difference difference(const Rgb8Image& a, const Rgb8Image& b, int bound) {
  Difference d;
  d.pixels = a.rgb.size() / 3;
  d.map = {a.width, a.height, std::vector<uint8_t>(a.rgb.size())};
  for (std::size_t i = 0; i < d.pixels; ++i) {
    int worst = 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
      worst = std::max(worst, std::abs(int{a.rgb[c]} - int{b.rgb[c]}));
    d.beyond += worst > bound;
    const uint8_t shown = static_cast<uint8_t>(worst > bound ? 255 : std::min(8 * worst, 128));
    std::fill_n(d.map.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, shown);
    if (worst <= d.largest) continue;
    d.largest = worst;
    d.x = static_cast<int>(i % static_cast<std::size_t>(a.width));
    d.y = static_cast<int>(i / static_cast<std::size_t>(a.width));
  }
  return d;
}

}  // namespace

testing::AssertionResult matches_golden(const Rgb8Image& picture, const fs::path& golden,
                                        const GoldenBound& bound, const fs::path& left_behind) {
  constexpr const char* how = " (PENUMBRA_RENEW_GOLDEN=1 renews it)";
  try {
    if (renewing()) {
      fs::create_directories(golden.parent_path());
      write_png(golden, picture);
      return testing::AssertionFailure()
             << golden << " was renewed: look at it, then test without PENUMBRA_RENEW_GOLDEN";
    }
    const fs::path folder = left_behind.empty() ? fs::path("build/golden") : left_behind;
    const auto leave = [&](const Rgb8Image& image, const std::string& suffix) {
      fs::create_directories(folder);
      const fs::path path = folder / (golden.stem().string() + suffix);
      write_png(path, image);
      return path;
    };
    if (!fs::exists(golden))
      return testing::AssertionFailure()
             << "no golden image " << golden << how << "; the picture is " << leave(picture, ".found.png");
    const Rgb8Image expected = read_png(golden);
    if (expected.width != picture.width || expected.height != picture.height)
      return testing::AssertionFailure()
             << golden << " is " << expected.width << " x " << expected.height << ", the picture "
             << picture.width << " x " << picture.height << how;
    const Difference d = difference(picture, expected, bound.per_channel);
    if (static_cast<double>(d.beyond) <= bound.share_beyond * static_cast<double>(d.pixels))
      return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << d.beyond << " of " << d.pixels << " pixels differ from " << golden << " by more than "
           << bound.per_channel << "; the worst is (" << d.x << ", " << d.y << ") by " << d.largest << how
           << "; the picture is " << leave(picture, ".found.png") << ", the differences "
           << leave(d.map, ".difference.png");
  } catch (const std::exception& e) {
    return testing::AssertionFailure() << e.what();
  }
}

}  // namespace penumbra::test
