#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "core/error.h"
#include "core/parallel.h"
#include "metrics/metrics.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

// LDR-FLIP once more, written from [Andersson 2020] and its errata: double precision, two-dimensional
// kernels, one sum per pixel. Slow on purpose.
namespace direct {

using Triple = std::array<double, 3>;
using Image = std::vector<Triple>;

// sRGB and D65 as the authors round them (a white of 0.95043, 1, 1.08890).
constexpr double xyz_from_rgb[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                       {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                       {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double rgb_from_xyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                       {-0.969224334, 1.875930071, 0.041554224},
                                       {0.055639423, -0.204011202, 1.057148933}};
constexpr Triple white = {0.950428545, 1.000000000, 1.088900371};

Triple times(const double (&m)[3][3], const Triple& v) {
  Triple r{};
  for (int i = 0; i < 3; ++i) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return r;
}

Triple ycxcz(const Vec3f& rgb) {
  const Triple linear = {std::clamp(double(rgb.x), 0.0, 1.0), std::clamp(double(rgb.y), 0.0, 1.0),
                         std::clamp(double(rgb.z), 0.0, 1.0)};
  const Triple xyz = times(xyz_from_rgb, linear);
  const double x = xyz[0] / white[0], y = xyz[1] / white[1], z = xyz[2] / white[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double lab_f(double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; }

Triple hunt_lab(const Triple& c) {
  const double y = (c[0] + 16) / 116, x = c[1] / 500 + y, z = y - c[2] / 200;
  Triple rgb = times(rgb_from_xyz, {x * white[0], y * white[1], z * white[2]});
  for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
  const Triple xyz = times(xyz_from_rgb, rgb);
  const double fx = lab_f(xyz[0] / white[0]), fy = lab_f(xyz[1] / white[1]), fz = lab_f(xyz[2] / white[2]);
  const double l = 116 * fy - 16;
  return {l, 0.01 * l * 500 * (fx - fy), 0.01 * l * 200 * (fy - fz)};
}

double hyab(const Triple& a, const Triple& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

struct Kernel {
  int radius;
  std::function<double(int, int)> weight;
};

double convolve(const std::vector<double>& image, int w, int h, int px, int py, const Kernel& k) {
  double sum = 0;
  for (int dy = -k.radius; dy <= k.radius; ++dy)
    for (int dx = -k.radius; dx <= k.radius; ++dx)
      sum +=
          k.weight(dx, dy) *
          image[static_cast<std::size_t>(std::clamp(py + dy, 0, h - 1) * w + std::clamp(px + dx, 0, w - 1))];
  return sum;
}

// Table of a kernel's weights, the positive ones scaled to a sum of 1 and the negative ones to -1.
Kernel tabulated(int radius, const std::function<double(int, int)>& f) {
  const int n = 2 * radius + 1;
  std::vector<double> t;
  double positive = 0, negative = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) {
      t.push_back(f(dx, dy));
      (t.back() > 0 ? positive : negative) += t.back();
    }
  for (double& v : t) v /= v > 0 ? positive : negative < 0 ? -negative : 1;
  return {radius, [t, radius, n](int dx, int dy) {
            return t[static_cast<std::size_t>((dy + radius) * n + dx + radius)];
          }};
}

struct Kernels {
  Kernel csf[3];
  Kernel edge_x, edge_y, point_x, point_y;
};

Kernels make_kernels(double ppd) {
  const double pi = 3.14159265358979323846;
  const double a1[3] = {1, 1, 34.1}, b1[3] = {0.0047, 0.0053, 0.04}, a2[3] = {0, 0, 13.5},
               b2[3] = {1e-5, 1e-5, 0.025};
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
  Kernels k;
  for (int c = 0; c < 3; ++c)
    k.csf[c] = tabulated(radius, [&, c](int dx, int dy) {
      const double d2 = (dx * dx + dy * dy) / (ppd * ppd);
      return a1[c] * std::sqrt(pi / b1[c]) * std::exp(-pi * pi * d2 / b1[c]) +
             a2[c] * std::sqrt(pi / b2[c]) * std::exp(-pi * pi * d2 / b2[c]);
    });
  const double sigma = 0.5 * 0.082 * ppd, s2 = sigma * sigma;
  const int r = static_cast<int>(std::ceil(3 * sigma));
  const auto g = [s2](int x, int y) { return std::exp(-(x * x + y * y) / (2 * s2)); };
  k.edge_x = tabulated(r, [&](int x, int y) { return -x * g(x, y); });
  k.edge_y = tabulated(r, [&](int x, int y) { return -y * g(x, y); });
  k.point_x = tabulated(r, [&](int x, int y) { return (x * x / s2 - 1) * g(x, y); });
  k.point_y = tabulated(r, [&](int x, int y) { return (y * y / s2 - 1) * g(x, y); });
  return k;
}

struct Seen {
  Triple color;
  double edge, point;
};

std::vector<Seen> see(const std::vector<Vec3f>& rgb, int w, int h, const Kernels& k) {
  std::vector<double> plane[3], gray;
  for (const Vec3f& v : rgb) {
    const Triple c = ycxcz(v);
    for (int i = 0; i < 3; ++i) plane[i].push_back(c[static_cast<std::size_t>(i)]);
    gray.push_back((c[0] + 16) / 116);
  }
  std::vector<Seen> seen;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      Triple filtered{};
      for (std::size_t c = 0; c < 3; ++c) filtered[c] = convolve(plane[c], w, h, x, y, k.csf[c]);
      seen.push_back(
          {hunt_lab(filtered),
           std::hypot(convolve(gray, w, h, x, y, k.edge_x), convolve(gray, w, h, x, y, k.edge_y)),
           std::hypot(convolve(gray, w, h, x, y, k.point_x), convolve(gray, w, h, x, y, k.point_y))});
    }
  return seen;
}

double remapped(const Triple& a, const Triple& b) {
  const double c_max = std::pow(hyab(hunt_lab(ycxcz({0, 1, 0})), hunt_lab(ycxcz({0, 0, 1}))), 0.7);
  const double d = std::pow(hyab(a, b), 0.7);
  return d < 0.4 * c_max ? 0.95 / (0.4 * c_max) * d : 0.95 + (d - 0.4 * c_max) / (0.6 * c_max) * 0.05;
}

std::vector<double> flip(const std::vector<Vec3f>& reference, const std::vector<Vec3f>& test, int w, int h,
                         double ppd) {
  const Kernels k = make_kernels(ppd);
  const std::vector<Seen> a = see(reference, w, h, k), b = see(test, w, h, k);
  std::vector<double> map;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double feature = std::max(std::abs(a[i].edge - b[i].edge), std::abs(a[i].point - b[i].point));
    map.push_back(std::pow(remapped(a[i].color, b[i].color), 1 - std::sqrt(feature / std::sqrt(2.0))));
  }
  return map;
}

}  // namespace direct

std::vector<Vec3f> constant(int n, Vec3f c) { return std::vector<Vec3f>(static_cast<std::size_t>(n), c); }

std::vector<Vec3f> noise(int n, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<Vec3f> v(static_cast<std::size_t>(n));
  for (Vec3f& c : v) c = {uniform(random), uniform(random), uniform(random)};
  return v;
}

// A soft disc's shade on gray, and the same with a ragged edge: what shadow images differ by.
std::vector<Vec3f> disc(int w, int h, double radius, double softness) {
  std::vector<Vec3f> v;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double d = std::hypot(x - w / 2.0, y - h / 2.0);
      const float shade = static_cast<float>(std::clamp((d - radius) / softness, 0.0, 1.0));
      v.push_back({0.7f * shade, 0.6f * shade, 0.5f * shade});
    }
  return v;
}

double largest_difference(const std::vector<float>& a, const std::vector<double>& b) {
  double d = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    d = std::max(d, std::abs(double(a[i]) - b[i]));
  return d;
}

TEST(Flip, EqualImagesGiveExactlyZeroEverywhere) {
  const std::vector<Vec3f> a = noise(40 * 30, 1);
  const FlipResult r = flip(a, a, 40, 30);
  EXPECT_EQ(r.mean, 0.0);
  EXPECT_TRUE(std::all_of(r.map.begin(), r.map.end(), [](float v) { return v == 0.0f; }));
}

TEST(Flip, GreenToBlueIsTheLargestDifferenceThereIs) {
  EXPECT_NEAR(flip(constant(9, {0, 1, 0}), constant(9, {0, 0, 1}), 3, 3).mean, 1.0, 1e-5);
}

TEST(Flip, BlackToWhiteByHand) {
  // Lightness differs by 100 and nothing else: 100^0.7 = 25.1189. The largest is 41.2761, its 0.4th
  // part 16.5104: 0.95 + 0.05 (25.1189 - 16.5104) / (41.2761 - 16.5104) = 0.96738.
  EXPECT_NEAR(flip(constant(64, {0, 0, 0}), constant(64, {1, 1, 1}), 8, 8).mean, 0.96738, 1e-5);
}

TEST(Flip, SmallGrayDifferencesAreStretchedByHand) {
  // Linear 0.18 and 0.20: L* 49.496 and 51.837, (2.3414)^0.7 = 1.8140, times 0.95 / 16.5104.
  const double f18 = 116 * std::cbrt(0.18) - 16, f20 = 116 * std::cbrt(0.20) - 16;
  const double expected = std::pow(f20 - f18, 0.7) * 0.95 / 16.51044;
  EXPECT_NEAR(flip(constant(64, {0.18f, 0.18f, 0.18f}), constant(64, {0.2f, 0.2f, 0.2f}), 8, 8).mean,
              expected, 2e-5);
}

TEST(Flip, IsSymmetric) {
  const std::vector<Vec3f> a = noise(31 * 17, 2), b = noise(31 * 17, 3);
  EXPECT_EQ(flip(a, b, 31, 17).map, flip(b, a, 31, 17).map);
}

TEST(Flip, StaysBetweenZeroAndOne) {
  const std::vector<Vec3f> a = noise(64 * 64, 4);
  std::vector<Vec3f> b = noise(64 * 64, 5);
  for (std::size_t i = 0; i < b.size(); i += 7) b[i] = {1, 1, 1};
  for (float v : flip(a, b, 64, 64, 20).map) {
    ASSERT_GE(v, 0.0f);
    ASSERT_LE(v, 1.0f);
  }
}

TEST(Flip, ValuesOutsideZeroToOneAreClamped) {
  EXPECT_EQ(flip(constant(4, {-3, 0, 0}), constant(4, {1, 1, 7}), 2, 2).mean,
            flip(constant(4, {0, 0, 0}), constant(4, {1, 1, 1}), 2, 2).mean);
}

TEST(Flip, AgreesWithTheDirectSumsOnNoise) {
  const std::vector<Vec3f> a = noise(37 * 29, 6), b = noise(37 * 29, 7);
  EXPECT_LT(largest_difference(flip(a, b, 37, 29).map, direct::flip(a, b, 37, 29, 67)), 2e-5);
}

TEST(Flip, AgreesWithTheDirectSumsOnASinglePixel) {
  const std::vector<Vec3f> a = constant(33 * 33, {0, 0, 0});
  std::vector<Vec3f> b = a;
  b[16 * 33 + 16] = {1, 1, 1};
  const FlipResult r = flip(a, b, 33, 33);
  const std::vector<double> expected = direct::flip(a, b, 33, 33, 67);
  EXPECT_LT(largest_difference(r.map, expected), 2e-5);
  // It is seen around where it is, most at its own place, and not beyond the filters' reach.
  EXPECT_EQ(std::max_element(r.map.begin(), r.map.end()) - r.map.begin(), 16 * 33 + 16);
  EXPECT_EQ(r.map[0], 0.0f);
}

TEST(Flip, AgreesWithTheDirectSumsOnShadesOfADisc) {
  const std::vector<Vec3f> a = disc(48, 40, 10, 8), b = disc(48, 40, 11, 5);
  EXPECT_LT(largest_difference(flip(a, b, 48, 40).map, direct::flip(a, b, 48, 40, 67)), 2e-4);
}

TEST(Flip, AgreesWithTheDirectSumsAtOddSizesAndResolutions) {
  for (const auto& [w, h, ppd] :
       {std::tuple(1, 1, 67.0), std::tuple(1, 20, 67.0), std::tuple(25, 2, 67.0), std::tuple(9, 70, 13.7),
        std::tuple(12, 11, 1.0), std::tuple(20, 15, 130.0)}) {
    const std::vector<Vec3f> a = noise(w * h, 8), b = noise(w * h, 9);
    EXPECT_LT(largest_difference(flip(a, b, w, h, ppd).map, direct::flip(a, b, w, h, ppd)), 2e-5)
        << w << " x " << h << " at " << ppd;
  }
}

TEST(Flip, TheMeanIsTheMapsMean) {
  const std::vector<Vec3f> a = noise(30 * 30, 10), b = noise(30 * 30, 11);
  const FlipResult r = flip(a, b, 30, 30);
  double sum = 0;
  for (float v : r.map) sum += double(v);
  EXPECT_EQ(r.mean, sum / 900);
}

TEST(Flip, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<Vec3f> a = noise(50 * 300, 12), b = noise(50 * 300, 13);
  set_threads(1);
  const FlipResult one = flip(a, b, 50, 300);
  set_threads(4);
  EXPECT_EQ(flip(a, b, 50, 300).map, one.map);
}

TEST(Flip, NotANumberEmptyAndUnequalImagesAreErrors) {
  std::vector<Vec3f> a = noise(12, 1), b = a;
  b[5].y = std::nanf("");
  EXPECT_NE(test::message_of<InputError>([&] { flip(a, b, 4, 3); }).find("nan at pixel (1, 1)"),
            std::string::npos);
  test::message_of<InputError>([&] { flip({}, {}, 0, 0); });
  test::message_of<InputError>([&] { flip(a, a, 4, 4); });
  test::message_of<InputError>([&] { flip(a, a, 4, 3, 0); });
}

}  // namespace
}  // namespace penumbra
