#include "techniques/stencil_shadow_volume/near_plane.h"

namespace penumbra::shadow_volume {
namespace {

constexpr double least_sine = 1e-4;  // of the light's elevation above the near plane
constexpr double least_distance =
    1e-6;  // from the light to a caster, as a share of its distance to the near plane

double dot4(Vec4d a, Vec4d b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

double farthest(Vec4d plane, const Box& box) {
  double d = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec4d corner{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z,
                       1};
    d = std::max(d, std::abs(dot4(plane, corner)));
  }
  return d;
}

}  // namespace

std::optional<Mat4d> near_plane_from_light(const Camera& camera, int width, int height, Vec4d light,
                                           const Box& bounds) {
  const Vec3d n = camera.basis().forward, eye(camera.eye);
  const double near = double{camera.near_plane};
  const Vec4d plane{n.x, n.y, n.z, -dot(n, eye) - near};
  const double above = dot4(plane, light), h = std::abs(above), side = above < 0 ? -1 : 1;
  const double reach = light.w == 0 ? 1 : length(light.xyz() - eye) + near;
  if (h <= least_sine * reach) return std::nullopt;
  // Q goes to the plane along the light's ray: h Q - (plane . Q) L, up to the sign that keeps w positive
  // between plane and light.
  Mat4d onto_plane;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) onto_plane[c][r] = (r == c ? h : 0.0) - side * plane[c] * light[r];
  Mat4d m = camera.clip_from_world(width, height) * onto_plane;
  // Depth is the distance from the plane towards the light, so small that only the plane itself ever clips: w
  // is `near` times the distance that is left to the light (times its elevation, for one at infinity).
  const double scale =
      near * (light.w == 0 ? h / std::max(2 * farthest(plane, bounds), 1e-30) : least_distance);
  for (int c = 0; c < 4; ++c) m[c].z = scale * side * plane[c];
  return m;
}

}  // namespace penumbra::shadow_volume
