#include "techniques/sample_based_soft/light_setup.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "samples/view_samples.h"
#include "techniques/common/light_frame.h"

namespace penumbra::sample_based_soft {
namespace {

Vec4f with_w(Vec3d v, double w = 0) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

bool is_rectangle(const Light& light) {
  return light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle;
}

Vec3d to_working(const FrameConstants& f, Vec3d world) {
  const Vec3d d = world - Vec3d(f.light.origin.xyz());
  return {dot(Vec3d(f.light.row_x.xyz()), d), dot(Vec3d(f.light.row_y.xyz()), d),
          dot(Vec3d(f.light.row_z.xyz()), d)};
}

void set_corners(LightBasis& basis, const Box& box) {
  basis.corner_count = 8;
  for (int i = 0; i < 8; ++i)
    basis.corners[i] = {i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z,
                        1};
}

void set_corners(LightBasis& basis, const Light& light) {
  basis.corner_count = 4;
  for (int i = 0; i < 4; ++i)
    basis.corners[i] = with_w(Vec3d(light.at(i & 1 ? 1.0f : 0.0f, i & 2 ? 1.0f : 0.0f)), 1);
}

// Unit: one light sample; sample (0, 0) at the origin.
void grid_space(LightSetup& s, const Light& light, Vec2f shift) {
  FrameConstants& f = s.constants;
  const MaskLayout& layout = s.layout;
  const Vec3d u(light.edge_u), v(light.edge_v), center(light.center);
  const double step_u = length(u) / layout.columns, step_v = length(v) / layout.rows;
  const Vec3d first = center - u * 0.5 - v * 0.5 + u * ((0.5 + double(shift.x)) / layout.columns) +
                      v * ((0.5 + double(shift.y)) / layout.rows);
  f.light.row_x = with_w(normalize(u) / step_u);
  f.light.row_y = with_w(normalize(v) / step_v);
  f.light.row_z = with_w(normalize(Vec3d(light.direction)) / std::sqrt(step_u * step_v));
  f.light.origin = with_w(first);
  f.first = with_w(first);
  f.step_u = with_w(u / static_cast<double>(layout.columns));
  f.step_v = with_w(v / static_cast<double>(layout.rows));
  f.eye = {0.5f * static_cast<float>(layout.columns - 1), 0.5f * static_cast<float>(layout.rows - 1), 0, 0};
}

// The world, turned and moved to the light's centre; with `scale` the world's directions are divided by it.
void turned_space(FrameConstants& f, Vec3d center, const LightFrame& axes, Vec3d scale) {
  f.light.row_x = with_w(axes.right / scale.x);
  f.light.row_y = with_w(axes.down / scale.y);
  f.light.row_z = with_w(axes.forward / scale.z);
  f.light.origin = with_w(center);
  f.eye = {0, 0, 0, 0};
}

// An ellipsoid about the samples' box, along the axes: its half sides times the square root of 3 hold the
// corners.
Vec3d ellipsoid(const LightSamples& samples, Vec3d center, const LightFrame& axes) {
  Vec3d half{};
  for (const Vec4f& p : samples.points) {
    const Vec3d d = Vec3d(p.xyz()) - center;
    half = max(half, Vec3d{std::abs(dot(d, axes.right)), std::abs(dot(d, axes.down)),
                           std::abs(dot(d, axes.forward))});
  }
  const double least = 1e-3 * std::max({half.x, half.y, half.z, 1e-12});
  return max(half, Vec3d{least, least, least}) * (1.001 * std::numbers::sqrt3);
}

void free_space(LightSetup& s, const Light& light, const LightSamples& samples, const Box& bounds) {
  FrameConstants& f = s.constants;
  const Vec3d middle(bounds.center());
  if (is_rectangle(light)) {
    const Vec3d u = normalize(Vec3d(light.edge_u)), v = normalize(Vec3d(light.edge_v));
    return turned_space(f, Vec3d(light.center), {u, v, normalize(Vec3d(light.direction))}, {1, 1, 1});
  }
  const Vec3d center(light.kind == LightKind::volume ? sample_box(samples).center() : light.center);
  Vec3d forward = light.kind == LightKind::spot ? Vec3d(light.direction) : middle - center;
  if (!(length(forward) > 0)) forward = {0, -1, 0};
  const LightFrame axes = light_frame(forward, {0, 1, 0});
  s.ball = samples.count() > 1;
  Vec3d scale{1, 1, 1};
  if (s.ball && light.kind == LightKind::sphere)
    scale = Vec3d{1, 1, 1} * (1.001 * double(light.radius));
  else if (s.ball)
    scale = ellipsoid(samples, center, axes);
  turned_space(f, center, axes, scale);
}

void set_scene(FrameConstants& f, const Box& bounds) {
  const Vec3d middle = 0.5 * (Vec3d(bounds.lo) + Vec3d(bounds.hi)), half = Vec3d(bounds.hi) - middle;
  const Vec3d at = to_working(f, middle);
  f.scene_middle = with_w(at);
  for (int k = 0; k < 3; ++k) {
    Vec3d side{};
    side[k] = half[k];
    f.scene_sides[k] = with_w(to_working(f, middle + side) - at);
  }
}

// Bounds of rounding, and of the lists' frustum.
void set_limits(FrameConstants& f, const Box& bounds) {
  double largest = 0, farthest = 0;
  Vec3d lo{INFINITY, INFINITY, INFINITY}, hi{-INFINITY, -INFINITY, -INFINITY};
  for (int i = 0; i < 8; ++i) {
    const Vec3f corner{i & 1 ? bounds.hi.x : bounds.lo.x, i & 2 ? bounds.hi.y : bounds.lo.y,
                       i & 4 ? bounds.hi.z : bounds.lo.z};
    const Vec3d c = to_working(f, Vec3d(corner)), q = c - Vec3d(f.eye.xyz());
    largest = std::max({largest, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
    farthest = std::max(farthest, q.z);
    lo = min(lo, q), hi = max(hi, q);
  }
  // Four units in the last place of the largest coordinate: the dot product's three roundings, and the
  // subtraction's.
  f.pad = static_cast<float>(std::max(largest * 0x1p-22, 1e-30));
  f.near = std::max(16 * f.pad, 1e-3f * static_cast<float>(farthest));
  f.farthest = static_cast<float>(farthest);
  // Twice as far to the side as ahead, in the world.
  const double across = std::max(double(length(f.light.row_x.xyz())), double(length(f.light.row_y.xyz())));
  f.widest = static_cast<float>(widest_tangent * across / double(length(f.light.row_z.xyz())));
  const double w = double(f.widest), near = std::max(lo.z, 1e-3 * farthest);
  f.window = {static_cast<float>(std::max(std::min(lo.x / near, lo.x / hi.z), -w)),
              static_cast<float>(std::max(std::min(lo.y / near, lo.y / hi.z), -w)),
              static_cast<float>(std::min(std::max(hi.x / near, hi.x / hi.z), w)),
              static_cast<float>(std::min(std::max(hi.y / near, hi.y / hi.z), w))};
}

// How pixels move the set (see FrameConstants); `box` and `radius` grow to what it then reaches.
void place_moves(LightSetup& s, const LightSamples& samples, Box& box, double& radius) {
  FrameConstants& f = s.constants;
  f.first.w = static_cast<float>(samples.move_seed);
  if (s.layout.grid || samples.move == PixelMove::none) return;
  const Vec3d x(f.light.row_x.xyz()), y(f.light.row_y.xyz()), z(f.light.row_z.xyz());
  if (samples.move == PixelMove::turn) {
    f.first = with_w(normalize(Vec3d{x.y, y.y, z.y}), samples.move_seed);
    f.step_u.w = dot(cross(x, y), z) < 0 ? -1.0f : 1.0f;
    const float r = static_cast<float>(radius);
    box.extend({-r, -r, -r}), box.extend({r, r, r});
    return;
  }
  const Vec3d u(samples.span_u), v(samples.span_v);
  f.step_u = with_w(u, length(u)), f.step_v = with_w(v, length(v));
  const Box world = samples.bounds();
  for (int i = 0; i < 8; ++i)
    box.extend(Vec3f(
        to_working(f, Vec3d{double(i & 1 ? world.hi.x : world.lo.x), double(i & 2 ? world.hi.y : world.lo.y),
                            double(i & 4 ? world.hi.z : world.lo.z)})));
  // In the light's plane.
  const Box own = box;
  box = {{own.lo.x, own.lo.y, 0}, {own.hi.x, own.hi.y, 0}};
  radius = length(Vec3d(max(-box.lo, box.hi)));
  for (std::size_t i = 0; i < samples.units.size(); ++i) {
    s.samples[i].w = samples.units[i].x;
    s.samples[samples.points.size() + i].w = samples.units[i].y;
  }
}

void place_samples(LightSetup& s, const LightSamples& samples) {
  FrameConstants& f = s.constants;
  s.samples = samples.points;
  // With the centre from which the lists see the scene: influence regions need it within the light.
  Box box;
  box.extend({});
  double radius = 1e-30;
  for (const Vec4f& p : samples.points) {
    const Vec3d q = to_working(f, Vec3d(p.xyz()));
    s.samples.push_back(with_w(q, 1));
    box.extend(Vec3f(q));
    radius = std::max(radius, length(q));
  }
  // Samples of a regular grid lie at whole numbers; the rows' rounding must not move them off their plane.
  if (s.layout.grid) {
    const float reach = samples.move == PixelMove::none ? 0 : 0.5f;
    box = {
        {-reach, -reach, 0},
        {static_cast<float>(s.layout.columns - 1) + reach, static_cast<float>(s.layout.rows - 1) + reach, 0}};
  }
  place_moves(s, samples, box, radius);
  s.radius = static_cast<float>(radius * 1.0001);
  const float grow = s.layout.grid ? 0 : f.pad;
  f.light_lo = {box.lo.x - grow, box.lo.y - grow, box.lo.z - grow, s.radius};
  f.light_hi = {box.hi.x + grow, box.hi.y + grow, box.hi.z + grow, 0};
}

constexpr std::size_t cluster = 16;  // light samples; as in mask_any.glsl

// Puts indices into an order in which each cluster's samples are neighbours: median cuts, at whole clusters.
// Clusters are long along z: what a triangle hides is a pencil of rays that do not lean far from it.
void cut(std::span<uint32_t> indices, std::span<const Vec4f> at) {
  if (indices.size() <= cluster) return;
  Box box;
  for (const uint32_t i : indices) box.extend(at[i].xyz());
  constexpr float lean = 0.3F;
  const Vec3f size = box.hi - box.lo, extent{size.x, size.y, lean * size.z};
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t half = (indices.size() / cluster + 1) / 2 * cluster;
  const auto along = [&](uint32_t i) { return std::pair(at[i].xyz()[axis], i); };
  std::ranges::nth_element(indices, indices.begin() + static_cast<std::ptrdiff_t>(half), {}, along);
  cut(indices.first(half), at);
  cut(indices.subspan(half), at);
}

// Walks in an order in which neighbours share half words, with a box about each: most triangles hide few of
// them.
void cluster_samples(LightSetup& s) {
  const std::size_t n = s.samples.size() / 2;
  const std::vector<Vec4f> old = s.samples;
  std::vector<uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  cut(order, std::span(old).subspan(n));
  s.places.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    s.samples[k] = old[order[k]], s.samples[n + k] = old[n + order[k]];
    s.places[order[k]] = static_cast<uint32_t>(k);
  }
  for (std::size_t first = 0; first < n; first += cluster) {
    Box box;
    for (std::size_t k = first; k < std::min(first + cluster, n); ++k) box.extend(s.samples[n + k].xyz());
    const Vec3f half = (box.hi - box.lo) * 0.5f, middle = box.lo + half;
    // The middle is rounded.
    const float pad =
        s.constants.pad + 1e-6f * (std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z));
    s.samples.push_back({middle.x, middle.y, middle.z, 0});
    s.samples.push_back({half.x + pad, half.y + pad, half.z + pad, 0});
  }
  s.layout.clustered = true, s.layout.packed = false;
}

}  // namespace

bool outside(const Box& light, const Box& instance) {
  for (int i = 0; i < 3; ++i)
    if (light.lo[i] > instance.hi[i] || light.hi[i] < instance.lo[i]) return true;
  return false;
}

Box sample_box(const LightSamples& samples) { return samples.bounds(); }

LightSetup light_setup(const Light& light, const LightSamples& samples, const Box& bounds, bool table) {
  LightSetup s;
  s.layout = mask_layout(light, samples);
  if (table && s.layout.grid) {
    s.layout.grid = false;
    s.layout.columns = s.layout.samples, s.layout.rows = 1, s.layout.pitch = 32;
    s.layout.words = s.layout.mask_words, s.layout.packed = true;
  }
  FrameConstants& f = s.constants;
  if (s.layout.grid)
    grid_space(s, light, samples.grid_shift);
  else
    free_space(s, light, samples, bounds);
  f.light.front_only = is_rectangle(light);
  f.front = with_w(Vec3d(light.direction), is_rectangle(light) ? 1 : 0);
  f.cone = {0, 0, 0, -2};
  f.apex = with_w(Vec3d(light.center));
  if (light.kind == LightKind::spot)
    f.cone = with_w(normalize(Vec3d(light.direction)),
                    std::cos(double(light.cone_degrees) * std::numbers::pi / 180));
  is_rectangle(light) ? set_corners(f.light, light) : set_corners(f.light, sample_box(samples));
  set_limits(f, bounds);
  set_scene(f, bounds);
  place_samples(s, samples);
  if (!s.layout.grid && !table && samples.count() > 32) cluster_samples(s);
  s.slack = 2 * relative_offset * bounds.diagonal();
  return s;
}

}  // namespace penumbra::sample_based_soft
