#include "techniques/common/shadow_maps/warp.h"

#include <numbers>

namespace penumbra::shadow_map {
namespace {

Vec4d homogeneous(Vec3d p) { return {p.x, p.y, p.z, 1}; }

// The homography (X, Y, W) -> rows, on light space. Depth is (distance along the axis - nearest) / w': it
// grows along each ray, and starts near 0, where floats are finest.
Mat4d embed(Vec3d x_row, Vec3d y_row, Vec3d w_row, const WarpInput& in) {
  Mat4d m;
  m[0] = {x_row.x, y_row.x, 0, w_row.x};
  m[1] = {x_row.y, y_row.y, 0, w_row.y};
  // Directional: Z is the distance, W = 1. Positioned: W is the distance, Z = -1.
  const bool at_infinity = in.light.at_infinity();
  const double nearest = (at_infinity ? in.extent.lo.z : -1 / in.extent.lo.z) - in.room;
  m[2] = {0, 0, at_infinity ? 1 : nearest, 0};
  m[3] = {x_row.z, y_row.z, at_infinity ? -nearest : 1, w_row.z};
  return m;
}

// x' = (x - center) / v, y' = -1 / v with v = y - (near edge - distance).
Mat4d perspective_along_y(double center, double distance, const WarpInput& in) {
  const double start = in.extent.lo.y - distance;
  return embed({1, 0, -center}, {0, 0, -1}, {0, 1, -start}, in);
}

// View depth of the point at (x, y) of the map, halfway into the body.
double view_depth(const WarpInput& in, double x, double y) {
  const Vec4d p = inverse(in.light_from_world) * Vec4d{x, y, 0.5 * (in.extent.lo.z + in.extent.hi.z), 1};
  return dot(in.camera.basis().forward, p.xyz() / p.w - Vec3d(in.camera.eye));
}

// Where the eye falls in the map: the warp is symmetric about it.
double eye_x(const WarpInput& in) {
  const Vec3d eye(in.camera.eye), forward = in.camera.basis().forward;
  for (double along : {0.0, in.extent.view_lo, in.extent.view_hi}) {
    const Vec4d e = in.light_from_world * homogeneous(eye + forward * along);
    if (e.w > 1e-9) return e.x / e.w;
  }
  return 0.5 * (in.extent.lo.x + in.extent.hi.x);
}

// The camera's projection of its own view samples' depth range, depth in [0, 1] and not reversed.
Mat4d camera_clip_from_world(const WarpInput& in) {
  const Camera::Basis b = in.camera.basis();
  const Vec3d eye(in.camera.eye), down = -b.up;
  const double tan_y = std::tan(0.5 * in.camera.vertical_fov_degrees * std::numbers::pi / 180);
  const double tan_x = tan_y * in.width / in.height;
  const double n = in.extent.view_lo, f = std::max(in.extent.view_hi, 1.001 * n), a = f / (f - n);
  const Vec3d rows[4] = {b.right / tan_x, down / tan_y, b.forward * a, b.forward};
  Mat4d m;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 3; ++c) m[c][r] = rows[r][c];
    m[3][r] = -dot(rows[r], eye) - (r == 2 ? a * n : 0);
  }
  return m;
}

// [Stamminger2002]: the map is drawn in the camera's post-perspective space, from where the
// light is there, framing the unit cube. Deviation: depth is kept from light space (embed), so that the order
// along rays holds also where perspective turns the light round (the source tests depth the other way there),
// and casters behind the viewer need no virtual camera moved back, as the source's do.
std::optional<Mat4d> psm(const WarpInput& in) {
  const Mat4d camera = camera_clip_from_world(in);
  const Vec4d light = camera * in.light.towards;
  const Vec3d cube_center{0, 0, 0.5};
  Mat4d look;  // image coordinates in rows 0 and 1, perspective divisor in row 3
  const double scale = std::max({std::abs(light.x), std::abs(light.y), std::abs(light.z)});
  if (!(scale > 0)) return {};
  const bool at_infinity = std::abs(light.w) < 1e-9 * scale;
  const Vec3d place = at_infinity ? Vec3d{} : light.xyz() / light.w;
  const LightFrame frame = light_frame(at_infinity ? -light.xyz() / scale : cube_center - place, {0, 0, 1});
  const Vec3d rows[2] = {frame.right, frame.down};
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 3; ++c) look[c][r] = rows[r][c];
    look[3][r] = -dot(rows[r], place);
  }
  if (!at_infinity) {
    for (int c = 0; c < 3; ++c) look[c][3] = frame.forward[c];
    look[3][3] = -dot(frame.forward, place);
    for (int i = 0; i < 8; ++i) {  // the light must see the whole cube in front of it
      const Vec3d corner{i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : 0.0};
      if (dot(frame.forward, corner - place) <= 1e-6 * length(place)) return {};
    }
  }
  const Mat4d m = look * camera * inverse(in.light_from_world);
  const auto row = [&](int r) { return Vec3d{m[0][r], m[1][r], m[3][r]}; };
  Vec3d x = row(0), y = row(1), w = row(3);
  if (dot(cross(x, y), w) < 0) x = -x;  // not mirrored: faces keep their sides
  return embed(x, y, w, in);
}

}  // namespace

std::optional<LightFrame> view_aligned(const LightPoint& light, Vec3d forward, const Camera& camera,
                                       double view_lo, double view_hi) {
  const Vec3d view = camera.basis().forward, eye(camera.eye);
  const LightFrame frame = light_frame(forward, view);
  if (light.at_infinity()) {
    if (length(cross(view, frame.forward)) < 0.02) return {};
    return frame;
  }
  const Mat4d m = light_from_world(light, frame);
  const Vec4d n = m * homogeneous(eye + view * view_lo), f = m * homogeneous(eye + view * view_hi);
  if (n.w <= 0 || f.w <= 0) return {};
  const Vec3d along{f.x / f.w - n.x / n.w, f.y / f.w - n.y / n.w, 0};
  if (length(along) < 0.02) return {};
  return light_frame(forward, frame.right * along.x + frame.down * along.y);
}

double lispsm_distance(double z0, double z1, double d) { return d / (std::sqrt(z1 / z0) - 1); }

double tsm_distance(double focus, double d, double xi) {
  return d * focus * (1 + xi) / (d - 2 * focus - d * xi);
}

double log_distance(double z0, double z1, double d) { return d / (z1 / z0 - 1); }

std::optional<Mat4d> warp(Warp kind, const WarpInput& in, double factor, double focus_share) {
  const Extent& e = in.extent;
  const double d = e.hi.y - e.lo.y, center = eye_x(in);
  if (!(d > 0)) return {};
  if (kind == Warp::psm) return psm(in);
  // View depths of the body's near and far edge, not nearer than the nearest view sample.
  const double z0 = std::max(view_depth(in, center, e.lo.y), e.view_lo);
  const double z1 = view_depth(in, center, e.hi.y);
  if (kind == Warp::tsm) {
    const double z = e.view_lo + focus_share * (e.view_hi - e.view_lo);
    const Vec4d p = in.light_from_world * homogeneous(Vec3d(in.camera.eye) + in.camera.basis().forward * z);
    if (p.w <= 0) return {};
    const double focus = std::clamp(p.y / p.w - e.lo.y, 0.01 * d, 0.7 * d);
    return perspective_along_y(center, tsm_distance(focus, d, -0.6), in);
  }
  if (!(z1 > 1.001 * z0)) return {};  // no depth is gained along the map: nothing to warp
  const double n = kind == Warp::log ? log_distance(z0, z1, d) : factor * lispsm_distance(z0, z1, d);
  return perspective_along_y(center, n, in);
}

}  // namespace penumbra::shadow_map
