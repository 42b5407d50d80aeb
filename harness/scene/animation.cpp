#include "scene/animation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

Timeline::Place Timeline::at(int frame) const {
  double when = frame;
  const double first = frames.front(), last = frames.back();
  if (loop && last > first && when > first) when = first + std::fmod(when - first, last - first);
  if (when <= first) return {0, 0, 0};
  if (when >= last) return {frames.size() - 1, frames.size() - 1, 0};
  const auto next =
      static_cast<std::size_t>(std::upper_bound(frames.begin(), frames.end(), when) - frames.begin());
  return {next - 1, next, (when - frames[next - 1]) / (frames[next] - frames[next - 1])};
}

Mat4d InstanceTrack::world_from_world(int frame) const {
  const auto [a, b, t] = timeline.at(frame);
  const double s = mix(scale[a], scale[b], t);
  return translation(mix(translate[a], translate[b], t) + pivot) *
         rotation(axis, mix(degrees[a], degrees[b], t)) * scaling({s, s, s}) * translation(-pivot);
}

namespace {

Vec3d unit(int axis) {
  Vec3d v;
  v[axis] = 1;
  return v;
}

Vec3d turn(Vec3d p, Vec3d about, Vec3d axis, double degrees) {
  return transform_vector(rotation(axis, degrees), p - about) + about;
}

}  // namespace

Vec3d Deformation::apply(Vec3d p, const Box& bounds, int frame) const {
  constexpr double tau = 2 * std::numbers::pi;
  const double phase = frame / period;
  if (kind == DeformationKind::wave)
    return p + unit(direction) * (amplitude * std::sin(tau * (p[axis] / wavelength - phase)));
  const double lo = double{bounds.lo[axis]}, extent = double{bounds.hi[axis]} - lo;
  const double h = extent > 0 ? (p[axis] - lo) / extent : 0;
  const double degrees = amplitude * std::sin(tau * phase) * h;
  Vec3d about = (Vec3d(bounds.lo) + Vec3d(bounds.hi)) * 0.5;
  if (kind == DeformationKind::twist) return turn(p, about, unit(axis), degrees);
  about[axis] = lo;
  return turn(p, about, cross(unit(axis), unit(direction)), degrees);
}

Vec3d Deformation::apply_to_normal(Vec3d p, Vec3d normal, const Box& bounds, int frame) const {
  // Two tangents carried along by central differences; their cross product is the new normal, on the same
  // side.
  const Vec3d helper = std::abs(normal.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalize(cross(normal, helper)), v = cross(normal, u);
  const double step = 1e-4 * std::max(double{bounds.diagonal()}, 1e-12);
  const auto carried = [&](Vec3d t) {
    return apply(p + t * step, bounds, frame) - apply(p - t * step, bounds, frame);
  };
  const Vec3d n = normalize(cross(carried(u), carried(v)));
  return n == Vec3d{} ? normal : n;
}

}  // namespace penumbra
