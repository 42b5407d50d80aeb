#include "techniques/gears/light_setup.h"

#include <cmath>
#include <numbers>

namespace penumbra::gears {
namespace {

Vec4f with_w(Vec3d v, float w = 0) {
  const Vec3f f(v);
  return {f.x, f.y, f.z, w};
}

Vec3d any_across(Vec3d axis) {
  const Vec3d other = std::abs(axis.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  return normalize(cross(axis, other));
}

// Box of the samples, and its corners as the light's convex hull.
Box sample_box(const LightSamples& samples) {
  Box box;
  for (const Vec4f& p : samples.points) box.extend(p.xyz());
  return box;
}

void set_corners(LightBasis& basis, const Box& box, bool infinite) {
  basis.corner_count = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3f c{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z};
    const Vec4f corner{c.x, c.y, c.z, infinite ? 0.0f : 1.0f};
    bool known = false;
    for (uint32_t k = 0; k < basis.corner_count; ++k) known = known || basis.corners[k] == corner;
    if (!known) basis.corners[basis.corner_count++] = corner;
  }
}

void set_corners(LightBasis& basis, const Light& light) {
  basis.corner_count = 4;
  for (int i = 0; i < 4; ++i)
    basis.corners[i] = with_w(Vec3d(light.at(i & 1 ? 1.0f : 0.0f, i & 2 ? 1.0f : 0.0f)), 1);
}

// Unit: one light sample; sample (0, 0) at the origin; z the distance before the light.
void grid_space(FrameConstants& f, const Light& light, const LightSamples& samples,
                const MaskLayout& layout) {
  const Vec3d u(light.edge_u), v(light.edge_v), center(light.center);
  const double step_u = length(u) / layout.columns, step_v = length(v) / layout.rows;
  const Vec2f shift = samples.grid_shift;
  const Vec3d first = center - u * 0.5 - v * 0.5 + u * ((0.5 + double(shift.x)) / layout.columns) +
                      v * ((0.5 + double(shift.y)) / layout.rows);
  f.light.row_x = with_w(normalize(u) / step_u);
  f.light.row_y = with_w(normalize(v) / step_v);
  f.light.row_z = with_w(normalize(Vec3d(light.direction)) / std::sqrt(step_u * step_v));
  f.light.origin = with_w(first);
  f.light.front_only = 1;
  f.first = with_w(first, static_cast<float>(samples.move_seed));
  f.step_u = with_w(u / static_cast<double>(layout.columns));
  f.step_v = with_w(v / static_cast<double>(layout.rows));
}

// The world, moved so that its numbers are small.
void world_space(FrameConstants& f, const Light& light, const Box& samples, bool infinite,
                 const Box& bounds) {
  const Vec3d origin(infinite ? bounds.center() : samples.center());
  f.light.row_x = {1, 0, 0, 0};
  f.light.row_y = {0, 1, 0, 0};
  f.light.row_z = {0, 0, 1, 0};
  f.light.origin = with_w(origin);
  const Vec3d move = infinite ? Vec3d{} : origin;
  f.light_lo = with_w(Vec3d(samples.lo) - move);
  f.light_hi = with_w(Vec3d(samples.hi) - move);
  const bool front = light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle;
  f.front = with_w(Vec3d(light.direction), front ? 1.0f : 0.0f);
}

Vec3d to_working(const FrameConstants& f, Vec3d world) {
  const Vec3d d = world - Vec3d(f.light.origin.xyz());
  return {dot(Vec3d(f.light.row_x.xyz()), d), dot(Vec3d(f.light.row_y.xyz()), d),
          dot(Vec3d(f.light.row_z.xyz()), d)};
}

// Camera C: at the light's centre, looking along its direction (a rectangle's front normal, a spot's axis, a
// directional light's rays, in parallel); a point, sphere or volume looks at the middle of the scene.
void grid_camera(FrameConstants& f, const Light& light, const LightSamples& samples, const MaskLayout& layout,
                 const Box& bounds) {
  const Vec3d middle = to_working(f, Vec3d(bounds.center()));
  const Vec3d eye = layout.infinite ? middle : to_working(f, Vec3d(sample_box(samples).center()));
  Vec3d axis{0, 0, 1};
  if (!layout.grid) {
    const bool directed = light.kind == LightKind::directional || light.kind == LightKind::spot ||
                          light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle;
    axis = normalize(directed ? Vec3d(light.direction) : middle - eye);
    if (!(length(axis) > 0)) axis = {0, 0, 1};
  }
  const Vec3d x = layout.grid ? Vec3d{1, 0, 0} : any_across(axis);
  f.camera_x = with_w(x);
  f.camera_y = with_w(cross(axis, x));
  f.camera_z = with_w(axis);
  f.camera_eye = with_w(eye, layout.infinite ? 0.0f : 1.0f);
  f.grid_unit = layout.infinite ? std::max(bounds.diagonal(), 1e-30f) : 1.0f;
}

}  // namespace

FrameConstants frame_constants(const Light& light, const LightSamples& samples, const MaskLayout& layout,
                               const Box& bounds, GearsParams::Extrusion extrusion) {
  FrameConstants f{};
  const Box box = sample_box(samples);
  if (layout.grid)
    grid_space(f, light, samples, layout);
  else
    world_space(f, light, box, layout.infinite, bounds);
  if (layout.grid)
    set_corners(f.light, light);
  else
    set_corners(f.light, box, layout.infinite);
  f.cone = {0, 0, 0, -2};
  f.apex = with_w(Vec3d(light.center));
  if (light.kind == LightKind::spot)
    f.cone = with_w(
        normalize(Vec3d(light.direction)),
        static_cast<float>(std::cos(static_cast<double>(light.cone_degrees) * std::numbers::pi / 180)));
  grid_camera(f, light, samples, layout, bounds);
  double largest = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3d c =
        to_working(f, {i & 1 ? static_cast<double>(bounds.hi.x) : static_cast<double>(bounds.lo.x),
                       i & 2 ? static_cast<double>(bounds.hi.y) : static_cast<double>(bounds.lo.y),
                       i & 4 ? static_cast<double>(bounds.hi.z) : static_cast<double>(bounds.lo.z)});
    largest = std::max({largest, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  }
  // Four units in the last place of the largest coordinate: the dot product's three roundings, and the
  // subtraction's.
  f.pad = static_cast<float>(std::max(largest * 0x1p-22, 1e-30));
  f.near = 16 * f.pad;
  f.paper_extrusion = extrusion == GearsParams::Extrusion::paper ? 1 : 0;
  return f;
}

}  // namespace penumbra::gears
