#include "core/vec.h"

#include <cassert>
#include <numbers>
#include <utility>

namespace penumbra {

Mat4d translation(Vec3d t) {
  Mat4d m;
  m[3] = {t.x, t.y, t.z, 1};
  return m;
}

Mat4d scaling(Vec3d s) {
  Mat4d m;
  m[0].x = s.x, m[1].y = s.y, m[2].z = s.z;
  return m;
}

Mat4d rotation(Vec3d axis, double degrees) {
  const double a = degrees * std::numbers::pi / 180.0;
  const double c = std::cos(a), s = std::sin(a), t = 1.0 - c;
  const Vec3d n = normalize(axis);
  Mat4d m;
  m[0] = {t * n.x * n.x + c, t * n.x * n.y + s * n.z, t * n.x * n.z - s * n.y, 0};
  m[1] = {t * n.x * n.y - s * n.z, t * n.y * n.y + c, t * n.y * n.z + s * n.x, 0};
  m[2] = {t * n.x * n.z + s * n.y, t * n.y * n.z - s * n.x, t * n.z * n.z + c, 0};
  return m;
}

// Gauss-Jordan with partial pivoting on [m | 1].
Mat4d inverse(const Mat4d& m) {
  double a[4][8] = {};
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) a[r][c] = m[c][r];
    a[r][4 + r] = 1;
  }
  for (int c = 0; c < 4; ++c) {
    int pivot = c;
    for (int r = c + 1; r < 4; ++r)
      if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
    assert(a[pivot][c] != 0 && "singular matrix");
    for (int k = 0; k < 8; ++k) std::swap(a[c][k], a[pivot][k]);
    const double scale = 1 / a[c][c];
    for (int k = 0; k < 8; ++k) a[c][k] *= scale;
    for (int r = 0; r < 4; ++r) {
      if (r == c) continue;
      const double f = a[r][c];
      for (int k = 0; k < 8; ++k) a[r][k] -= f * a[c][k];
    }
  }
  Mat4d out;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) out[c][r] = a[r][4 + c];
  return out;
}

Mat4f to_float(const Mat4d& m) {
  Mat4f out;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) out[c][r] = static_cast<float>(m[c][r]);
  return out;
}

}  // namespace penumbra
