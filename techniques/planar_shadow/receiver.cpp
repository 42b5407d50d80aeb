#include "techniques/planar_shadow/receiver.h"

#include <fmt/format.h>

namespace penumbra::planar_shadow {
namespace {

constexpr double flatness = 1e-5;  // of the scene's diagonal

Vec3d corner(const Geometry& g, std::size_t triangle, int i) { return Vec3d(g.corner(triangle, i)); }

double dot4(Vec4d a, Vec4d b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

// A plane per instance through its largest triangle, and the instance's area; area 0: not flat.
std::vector<Receiver> flat_instances(const Geometry& g) {
  std::vector<Receiver> found(g.instance_albedo.size());
  std::vector<double> largest(found.size(), 0);
  for (std::size_t t = 0; t < g.triangle_count(); ++t) {
    const uint32_t i = g.triangle_instance[t];
    const Vec3d a = corner(g, t, 0), n = cross(corner(g, t, 1) - a, corner(g, t, 2) - a);
    found[i].instance = i, found[i].area += length(n) / 2;
    if (length(n) <= largest[i]) continue;
    largest[i] = length(n);
    const Vec3d unit = normalize(n);
    found[i].plane = {unit.x, unit.y, unit.z, -dot(unit, a)};
  }
  const double tolerance = flatness * double{g.bounds.diagonal()};
  for (std::size_t t = 0; t < g.triangle_count(); ++t) {
    Receiver& r = found[g.triangle_instance[t]];
    const Vec3d a = corner(g, t, 0), n = cross(corner(g, t, 1) - a, corner(g, t, 2) - a);
    r.tilt = std::max(r.tilt, length(n) > 0 ? length(cross(normalize(n), r.plane.xyz())) : 0.0);
    for (int k = 0; k < 3; ++k) {
      const Vec3d p = corner(g, t, k);
      r.bounds.extend(g.corner(t, k));
      if (std::abs(dot4(r.plane, {p.x, p.y, p.z, 1})) > tolerance) r.area = 0;
    }
  }
  return found;
}

}  // namespace

std::variant<Receiver, std::string> find_receiver(const Geometry& geometry, int wanted) {
  const std::vector<Receiver> found = flat_instances(geometry);
  if (wanted >= static_cast<int>(found.size()))
    return fmt::format("The scene has {} instances, receiver is {}.", found.size(), wanted);
  if (wanted >= 0) {
    const Receiver& r = found[static_cast<std::size_t>(wanted)];
    if (r.area > 0) return r;
    return fmt::format("Instance {} is not flat: a planar shadow falls on one plane.", wanted);
  }
  Receiver best;
  for (const Receiver& r : found)
    if (r.area > best.area) best = r;
  if (best.area > 0) return best;
  return std::string("No instance of the scene is flat: a planar shadow falls on one plane.");
}

bool same_horizon(const Receiver& receiver, const LightSamples& samples, Vec4f emission, Vec3d eye,
                  std::vector<uint32_t>& dark) {
  dark.assign(static_cast<std::size_t>(samples.mask_words()), 0);
  const Box& box = receiver.bounds;
  const Vec3d middle(box.center());
  const double radius = double{box.diagonal()} / 2;
  // How far from the receiver's plane a point must be to lie on one side of all of its triangles.
  const auto clear = [&](Vec4d point) {
    const double away = point.w == 0 ? 1 : length(point.xyz() - middle) + radius;
    return std::abs(dot4(receiver.plane, point)) > (2 * receiver.tilt + 1e-4) * away;
  };
  const Vec4d viewer{eye.x, eye.y, eye.z, 1};
  if (!clear(viewer)) return false;
  if (emission.w > -1 && emission.w != 0) return false;  // a cone's rim is a curve on the receiver
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Vec4f l = samples.points[i];
    const Vec4d light{l.x, l.y, l.z, l.w};
    if (!clear(light)) return false;
    const bool lit = (dot4(receiver.plane, light) > 0) == (dot4(receiver.plane, viewer) > 0);
    if (!lit) dark[i / 32] |= 1U << (i % 32);
  }
  return true;
}

std::vector<uint32_t> occluder_indices(const Geometry& geometry, uint32_t receiver) {
  std::vector<uint32_t> indices;
  for (std::size_t t = 0; t < geometry.triangle_count(); ++t)
    if (geometry.triangle_instance[t] != receiver)
      indices.insert(indices.end(), &geometry.indices[3 * t], &geometry.indices[3 * t] + 3);
  return indices;
}

Mat4d onto_plane(Vec4d plane, Vec4d light) {
  const double above = dot4(plane, light), side = above < 0 ? -1 : 1;
  Mat4d m;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) m[c][r] = (r == c ? std::abs(above) : 0.0) - side * plane[c] * light[r];
  return m;
}

}  // namespace penumbra::planar_shadow
