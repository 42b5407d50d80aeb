#include "scene/camera.h"

#include <numbers>

namespace penumbra {
namespace {

// Half the picture's height at view distance 1.
double half_height(const Camera& c) {
  return std::tan(double{c.vertical_fov_degrees} * std::numbers::pi / 360.0);
}

}  // namespace

Camera::Basis Camera::basis() const {
  const Vec3d forward = normalize(Vec3d(target) - Vec3d(eye));
  const Vec3d right = normalize(cross(forward, Vec3d(up)));
  return {right, cross(right, forward), forward};
}

Mat4d Camera::clip_from_world(int width, int height) const {
  const Basis b = basis();
  const double sy = 1.0 / half_height(*this);
  const double sx = sy * height / width;
  const Vec3d rows[2] = {b.right * sx, b.up * -sy};
  const Vec3d e(eye);
  Mat4d m;
  for (int c = 0; c < 3; ++c) m[c] = {rows[0][c], rows[1][c], 0, b.forward[c]};
  m[3] = {-dot(rows[0], e), -dot(rows[1], e), double{near_plane}, -dot(b.forward, e)};
  return m;
}

Vec3d Camera::ray_direction(double x, double y, int width, int height) const {
  const Basis b = basis();
  const double t = half_height(*this);
  return b.forward + b.right * ((2 * x / width - 1) * t * width / height) + b.up * ((1 - 2 * y / height) * t);
}

}  // namespace penumbra
