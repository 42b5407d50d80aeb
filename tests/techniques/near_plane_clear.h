// Where z-pass has to be right, decided by clipping in double precision.
#pragma once
#include <utility>
#include <vector>

#include "stencil_planar_stage.h"

namespace penumbra::test {

// What is left of the polygon on the inner side of a plane through the origin.
inline std::vector<Vec3d> clipped(const std::vector<Vec3d>& polygon, Vec4d plane) {
  const auto height = [&](Vec3d p) { return dot(plane.xyz(), p) + plane.w; };
  std::vector<Vec3d> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double ha = height(a), hb = height(b);
    if (ha >= 0) out.push_back(a);
    if ((ha < 0) != (hb < 0)) out.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  return out;
}

// Whether the whole near plane's rectangle lies outside all volumes: nothing is between it and the light.
inline bool near_plane_is_clear(const Stage& stage) {
  const Camera& camera = stage.frame.camera;
  const Vec4d light = stage.towards();
  const Vec3d eye(camera.eye);
  std::vector<Vec3d> corner;
  const int w = stage.view.width(), h = stage.view.height();
  for (const auto& [x, y] : {std::pair{0, 0}, {w, 0}, {w, h}, {0, h}})
    corner.push_back(eye + camera.ray_direction(x, y, w, h) * double{camera.near_plane});
  const auto plane = [](Vec3d n, Vec3d through, Vec3d inside) {
    const double offset = -dot(n, through), s = dot(n, inside) + offset < 0 ? -1 : 1;
    return Vec4d{s * n.x, s * n.y, s * n.z, s * offset};
  };
  const Vec3d middle = (corner[0] + corner[2]) * 0.5;
  const Vec3d along = light.xyz() - middle * light.w;
  const Vec3d inside = middle + along * (light.w != 0 ? 0.5 : 1.0);
  std::vector<Vec4d> planes{plane(cross(corner[1] - corner[0], corner[3] - corner[0]), corner[0], inside)};
  for (std::size_t i = 0; i < 4; ++i)
    planes.push_back(
        plane(cross(corner[(i + 1) % 4] - corner[i], light.xyz() - corner[i] * light.w), corner[i], inside));
  const Geometry& g = stage.frame.geometry;
  for (std::size_t t = 0; t < g.triangle_count(); ++t) {
    std::vector<Vec3d> polygon{Vec3d(g.corner(t, 0)), Vec3d(g.corner(t, 1)), Vec3d(g.corner(t, 2))};
    for (const Vec4d& p : planes) polygon = clipped(polygon, p);
    if (!polygon.empty()) return false;
  }
  return true;
}

}  // namespace penumbra::test
