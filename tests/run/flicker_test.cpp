#include "run/flicker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/support/host_view.h"

namespace penumbra::run {
namespace {

constexpr int width = 61, height = 47;

Frame ground_and_box(Vec3f eye, float box_x = 0) {
  Frame f;
  testing::add_ground(f.geometry, 20);
  testing::add_box(f.geometry, {box_x - 0.5f, 0, -0.5f}, {box_x + 0.5f, 1, 0.5f});
  f.camera.eye = eye, f.camera.target = eye + Vec3f{0, -3, -4};
  return f;
}

testing::HostView seen(const Frame& f) { return testing::see(f.geometry, f.camera, width, height); }

std::vector<float> pattern(const testing::HostView& view, const std::function<float(std::size_t)>& error) {
  std::vector<float> e(view.triangle.size(), NAN);
  for (std::size_t i = 0; i < e.size(); ++i)
    if (view.triangle[i] != no_triangle) e[i] = error(i);
  return e;
}

// Stripes several pixels wide, fixed to the world.
float stripe(Vec4f p) { return std::fmod(std::abs(p.x + 0.7f * p.z) + 0.2f, 3.0f) < 1.5f ? 1.0f : 0.0f; }

TEST(Flicker, IsTheMeanChangeOfTheErrorWhereBothFramesCount) {
  const std::vector<float> v0 = {1, 0.5f, 0}, r0 = {1, 0.25f, 0}, v1 = {0.5f, 0.5f, 1}, r1 = {1, 0.25f, 0};
  const std::vector<uint8_t> all = {1, 1, 1}, two = {1, 1, 0}, nowhere = {0, 0, 0};
  const auto e0 = signed_error(v0, r0, all), e1 = signed_error(v1, r1, two);
  // |-0.5 - 0| and |0.25 - 0.25|; the third does not count.
  EXPECT_DOUBLE_EQ(flicker(e1, e0, same_pixels(3)), 0.25);
  EXPECT_TRUE(flicker(signed_error(v0, r0, nowhere), e1, same_pixels(3)).is_null());
}

TEST(Flicker, OfErrorsThatStandStillInTheWorldIsZeroWhileTheCameraMoves) {
  const Frame before = ground_and_box({0, 3, 4}), now = ground_and_box({0.137f, 3.05f, 3.9f});
  const testing::HostView a = seen(before), b = seen(now);
  const auto past = past_pixels(b.host(), a.host(), before);
  const auto ground_only = [](const testing::HostView& v) {
    return pattern(v, [&](std::size_t i) { return v.position[i].y < 1e-3f ? stripe(v.position[i]) : 0.0f; });
  };
  EXPECT_EQ(flicker(ground_only(b), ground_only(a), past), 0.0);
  // The same pixel of the picture before shows another place.
  EXPECT_GT(flicker(ground_only(b), ground_only(a), same_pixels(past.size())), 0.02);
}

TEST(Flicker, OfErrorsThatMoveWithTheCameraIsSeen) {
  const Frame before = ground_and_box({0, 3, 4}), now = ground_and_box({0.4f, 3, 4});
  const testing::HostView a = seen(before), b = seen(now);
  const auto past = past_pixels(b.host(), a.host(), before);
  const auto columns = [](const testing::HostView& v) {
    return pattern(v, [](std::size_t i) { return (i % width) / 8 % 2 ? 1.0f : 0.0f; });
  };
  EXPECT_GT(flicker(columns(b), columns(a), past), 0.2);
}

TEST(Flicker, FollowsMovingSurfacesAndLeavesOutWhatWasHidden) {
  const Frame before = ground_and_box({0, 3, 4}, 0), now = ground_and_box({0, 3, 4}, 0.3f);
  const testing::HostView a = seen(before), b = seen(now);
  const auto past = past_pixels(b.host(), a.host(), before);
  // Painted on the box: moves with it. The ground next to it comes out from behind.
  const auto painted = [](const testing::HostView& v, float box_x) {
    return pattern(v, [&](std::size_t i) {
      const Vec4f p = v.position[i];
      return p.y > 1e-3f ? (p.x - box_x > 0 ? 1.0f : 0.0f) : 0.0f;
    });
  };
  EXPECT_EQ(flicker(painted(b, 0.3f), painted(a, 0), past), 0.0);
  EXPECT_GT(flicker(painted(b, 0.3f), painted(a, 0), same_pixels(past.size())), 0.0);
  int hidden = 0;
  for (std::size_t i = 0; i < past.size(); ++i) {
    const bool none = std::ranges::all_of(past[i], [](uint32_t p) { return p == no_pixel; });
    if (b.triangle[i] == no_triangle || a.triangle[i] == no_triangle) continue;
    if (none) ++hidden;
    // What was on the box is on the box now, and what comes out from behind was nowhere.
    for (const uint32_t p : past[i])
      if (p != no_pixel) {
        EXPECT_EQ(a.triangle[p] < 2, b.triangle[i] < 2) << i;
      }
  }
  EXPECT_GT(hidden, 10);
}

}  // namespace
}  // namespace penumbra::run
