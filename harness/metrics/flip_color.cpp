#include "metrics/flip_color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace penumbra::flip_color {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix inverted(const Matrix& m) {
  Matrix r{};
  const auto minor = [&](std::size_t i, std::size_t j) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const double det = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) r[j][i] = minor(i, j) / det;
  return r;
}

// XYZ relative to the white (so that white is 1 1 1) from linear RGB, from sRGB's primaries and D65 as
// chromaticities. Column i of `primaries` is the colour of primary i up to its strength, which is what makes
// their sum the white.
Matrix relative_xyz_from_rgb() {
  constexpr double xy[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
  constexpr double white_x = 0.31271, white_y = 0.32902;
  const std::array<double, 3> white = {white_x / white_y, 1, (1 - white_x - white_y) / white_y};
  Matrix primaries{};
  for (std::size_t i = 0; i < 3; ++i)
    primaries[0][i] = xy[i][0], primaries[1][i] = xy[i][1], primaries[2][i] = 1 - xy[i][0] - xy[i][1];
  const Matrix strength_from_xyz = inverted(primaries);
  Matrix m{};
  for (std::size_t i = 0; i < 3; ++i) {
    double strength = 0;
    for (std::size_t j = 0; j < 3; ++j) strength += strength_from_xyz[i][j] * white[j];
    for (std::size_t j = 0; j < 3; ++j) m[j][i] = primaries[j][i] * strength / white[j];
  }
  return m;
}

struct Float3x3 {
  explicit Float3x3(const Matrix& m) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) v[i][j] = static_cast<float>(m[i][j]);
  }
  Vec3f operator*(Vec3f p) const {
    return {v[0][0] * p.x + v[0][1] * p.y + v[0][2] * p.z, v[1][0] * p.x + v[1][1] * p.y + v[1][2] * p.z,
            v[2][0] * p.x + v[2][1] * p.y + v[2][2] * p.z};
  }
  float v[3][3];
};

const Float3x3 xyz_from_rgb{relative_xyz_from_rgb()};
const Float3x3 rgb_from_xyz{inverted(relative_xyz_from_rgb())};

Vec3f clamped(Vec3f c) {
  return {std::clamp(c.x, 0.0f, 1.0f), std::clamp(c.y, 0.0f, 1.0f), std::clamp(c.z, 0.0f, 1.0f)};
}

// CIE Lab's cube root, with its straight piece near black.
float lab_curve(float t) {
  constexpr float delta = 6.0f / 29.0f;
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29.0f;
}

}  // namespace

Vec3f opponent_from_linear(Vec3f rgb) {
  const Vec3f xyz = xyz_from_rgb * clamped(rgb);
  return {xyz.y, xyz.x - xyz.y, xyz.y - xyz.z};
}

Vec3f hunt_lab_from_opponent(Vec3f opponent) {
  const float y = opponent.x;
  const Vec3f xyz = xyz_from_rgb * clamped(rgb_from_xyz * Vec3f{y + opponent.y, y, y - opponent.z});
  const float fx = lab_curve(xyz.x), fy = lab_curve(xyz.y), fz = lab_curve(xyz.z);
  const float lightness = 116 * fy - 16;
  const float hunt = 0.01f * lightness;
  return {lightness, hunt * 500 * (fx - fy), hunt * 200 * (fy - fz)};
}

float hyab(Vec3f p, Vec3f q) {
  return std::abs(p.x - q.x) + std::sqrt((p.y - q.y) * (p.y - q.y) + (p.z - q.z) * (p.z - q.z));
}

}  // namespace penumbra::flip_color
