#include "techniques/depth_complexity_sampling/light_space.h"

#include <array>
#include <cmath>

namespace penumbra::depth_complexity {
namespace {

constexpr int most_columns = 64;     // a row of a grid is one machine word of candidates
constexpr double margin = 1.0 / 64;  // of a step between samples, beyond any rounding

bool is_rectangle(const Light& light) {
  return light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle;
}

// Whether the samples are the cell centres of a grid on the rectangle.
bool is_grid(const Light& light, const LightSamples& samples) {
  const int w = samples.width, h = samples.height;
  if (!is_rectangle(light) || w < 1 || h < 1 || w > most_columns || h > most_columns ||
      samples.count() != w * h)
    return false;
  for (int i = 0; i < samples.count(); ++i) {
    const Vec3f at = light.at((static_cast<float>(i % w) + 0.5F) / static_cast<float>(w),
                              (static_cast<float>(i / w) + 0.5F) / static_cast<float>(h));
    const Vec4f p = samples.points[static_cast<std::size_t>(i)];
    const float rounding = 1e-6F * (std::abs(at.x) + std::abs(at.y) + std::abs(at.z));
    if (length(p.xyz() - at) > rounding + 1e-5F * light.size() / static_cast<float>(std::max(w, h)))
      return false;
  }
  return true;
}

Box box_of(const LightSamples& samples) {
  Box box;
  for (const Vec4f& p : samples.points) box.extend(p.xyz());
  return box;
}

// How far the geometry's bounds lie in front of the foremost light sample, along the axis.
double clearance(Vec3d axis, const LightSamples& samples, const Box& bounds) {
  double front = -INFINITY, nearest = 0;
  for (const Vec4f& p : samples.points) front = std::max(front, dot(axis, Vec3d(p.xyz())));
  for (int i = 0; i < 3; ++i)
    nearest += axis[i] * static_cast<double>(axis[i] > 0 ? bounds.lo[i] : bounds.hi[i]);
  return nearest - front;
}

// For lights that are no rectangle: a direction in which all geometry lies before all samples.
std::optional<Vec3d> free_axis(const LightSamples& samples, const Box& bounds) {
  const Vec3d towards = normalize(Vec3d(bounds.center()) - Vec3d(box_of(samples).center()));
  const std::array<Vec3d, 7> axes{towards,        Vec3d{0, -1, 0}, Vec3d{0, 1, 0}, Vec3d{-1, 0, 0},
                                  Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{0, 0, 1}};
  const Vec3d* best = nullptr;
  double most = 1e-5 * static_cast<double>(bounds.diagonal());
  for (const Vec3d& axis : axes)
    if (const double c = clearance(axis, samples, bounds); c > most) most = c, best = &axis;
  return best ? std::optional(*best) : std::nullopt;
}

Vec3d any_across(Vec3d axis) {
  return normalize(cross(axis, std::abs(axis.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
}

void use_grid(LightSpace& s, const Light& light, const LightSamples& samples) {
  const Vec3d u(light.edge_u), v(light.edge_v);
  const double step_u = length(u) / samples.width, step_v = length(v) / samples.height;
  s.grid = true;
  s.columns = samples.width, s.rows = samples.height;
  s.origin = Vec3d(light.center) - u * 0.5 - v * 0.5 + u * (0.5 / s.columns) + v * (0.5 / s.rows);
  s.x = normalize(u) / step_u;
  s.y = normalize(v) / step_v;
  s.z = normalize(Vec3d(light.direction)) / std::sqrt(step_u * step_v);
  s.lo = {0, 0, 0};
  s.hi = {static_cast<float>(s.columns - 1), static_cast<float>(s.rows - 1), 0};
}

void use_set(LightSpace& s, const Light& light, const LightSamples& samples, const Box& bounds) {
  const Vec3d axis = is_rectangle(light) ? normalize(Vec3d(light.direction)) : *free_axis(samples, bounds);
  const Vec3d across = is_rectangle(light) ? normalize(Vec3d(light.edge_u)) : any_across(axis);
  const Box box = box_of(samples);
  // The foremost sample is at z = 0. Units: about a step between samples; anything for a single one.
  double front = -INFINITY;
  for (const Vec4f& p : samples.points)
    front = std::max(front, dot(axis, Vec3d(p.xyz()) - Vec3d(box.center())));
  s.planar = is_rectangle(light) || samples.count() == 1;
  if (is_rectangle(light)) front = dot(axis, Vec3d(light.center) - Vec3d(box.center()));
  double unit = static_cast<double>(box.diagonal()) / std::sqrt(static_cast<double>(samples.count()));
  if (!(unit > 0)) unit = 1e-3 * static_cast<double>(bounds.diagonal());
  s.origin = Vec3d(box.center()) + axis * front;
  s.x = across / unit;
  s.y = cross(axis, across) / unit;
  s.z = axis / unit;
  Box b;
  for (const Vec4f& p : samples.points) {
    Vec3f q = s.from_world(p.xyz());
    q.z = s.planar ? 0.0F : std::min(q.z, 0.0F);
    b.extend(q);
    s.points_x.push_back(q.x), s.points_y.push_back(q.y), s.points_z.push_back(q.z);
  }
  while (s.points_x.size() % 16 != 0) {
    s.points_x.push_back(s.points_x.back());
    s.points_y.push_back(s.points_y.back());
    s.points_z.push_back(s.points_z.back());
  }
  s.lo = b.lo, s.hi = b.hi;
}

}  // namespace

std::optional<std::string> light_space_fails(const Light& light, const LightSamples& samples,
                                             const Box& bounds) {
  if (samples.points.empty() || samples.points.front().w == 0)
    return "Depth complexity is sampled between points: a directional light has none.";
  if (is_rectangle(light) || free_axis(samples, bounds)) return std::nullopt;
  return "No plane parts this light from the geometry's bounds: depth complexity is counted on a plane "
         "before the "
         "light, with everything in front of it.";
}

LightSpace make_light_space(const Light& light, const LightSamples& samples, const Box& bounds) {
  LightSpace s;
  s.sample_count = samples.points.size();
  if (is_grid(light, samples))
    use_grid(s, light, samples);
  else
    use_set(s, light, samples, bounds);
  const auto m = static_cast<float>(margin);
  s.lo.x -= m, s.lo.y -= m, s.hi.x += m, s.hi.y += m;
  for (const Vec3f& p : {s.lo, s.hi})
    s.magnitude = std::max({s.magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  for (int i = 0; i < 8; ++i) {
    const Vec3f p = s.from_world({i & 1 ? bounds.hi.x : bounds.lo.x, i & 2 ? bounds.hi.y : bounds.lo.y,
                                  i & 4 ? bounds.hi.z : bounds.lo.z});
    s.magnitude = std::max({s.magnitude, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  return s;
}

}  // namespace penumbra::depth_complexity
