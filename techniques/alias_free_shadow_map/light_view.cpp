#include "techniques/alias_free_shadow_map/light_view.h"

#include <algorithm>
#include <bit>
#include <numbers>

namespace penumbra::alias_free {
namespace {

// Undoes the order-preserving encoding of bounds.comp.
double decoded(uint32_t u) { return std::bit_cast<float>(u & 0x80000000U ? u & 0x7fffffffU : ~u); }

Vec4f with_w(Vec3d v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

Vec3d smallest_axis(Vec3d v) {
  const Vec3d a{std::abs(v.x), std::abs(v.y), std::abs(v.z)};
  return a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0} : a.y <= a.z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
}

Face face_along(Vec3d forward, Vec3d hint) {
  forward = normalize(forward);
  Vec3d down = hint - forward * dot(hint, forward);
  if (!(length(down) > 1e-6 * length(hint))) {
    const Vec3d axis = smallest_axis(forward);
    down = axis - forward * dot(axis, forward);
  }
  down = normalize(down);
  return {with_w(cross(down, forward), 0), with_w(down, 0), with_w(forward, 0), {}, {}};
}

}  // namespace

Extent decode(const SampleBounds& b) {
  Extent e;
  e.whole = b.outside != 0;
  if (b.lo[0] == 0xffffffffU) return e;
  for (int c = 0; c < 3; ++c) e.lo[c] = decoded(b.lo[c]), e.hi[c] = decoded(~b.hi[c]);
  return e;
}

LightView begin_view(const Light& light, const Box& scene) {
  LightView v{};
  const Vec3d direction = normalize(Vec3d(light.direction));
  v.light = with_w(Vec3d(light.center), 1);
  v.center = v.light;
  v.emission = with_w(direction, -1);
  if (light.kind == LightKind::directional) {
    v.light = with_w(-direction, 0);
    v.center = with_w(Vec3d(scene.center()), 0);
  }
  if (light.kind == LightKind::spot) v.emission.w = static_cast<float>(std::cos(light.cone_degrees * std::numbers::pi / 180));
  if (light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle) v.emission.w = 0;
  return v;
}

void aim(LightView& view, const Light& light, Vec3d towards, Vec3d hint) {
  const bool given = light.kind == LightKind::directional || light.kind == LightKind::spot;
  Vec3d forward = given ? Vec3d(light.direction) : towards;
  if (!(length(forward) > 0)) forward = {0, -1, 0};
  view.face_count = 1;
  view.faces[0] = face_along(forward, hint);
}

void aim_cube(LightView& view) {
  view.face_count = most_faces;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      Vec3d forward, hint;  // the cube's own axes: only then do the faces meet
      forward[axis] = side ? -1 : 1, hint[(axis + 1) % 3] = 1;
      view.faces[2 * axis + side] = face_along(forward, hint);
    }
}

std::optional<Extent> extent_of(const LightView& view, Vec3d lo, Vec3d hi) {
  const Face& f = view.faces[0];
  const bool parallel = view.light.w == 0;
  Extent e;
  for (int i = 0; i < 8; ++i) {
    const Vec3d q{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z};
    const double depth = dot(Vec3d(f.forward.xyz()), q), w = parallel ? 1 : depth;
    const Vec3d p{dot(Vec3d(f.right.xyz()), q) / w, dot(Vec3d(f.down.xyz()), q) / w, depth};
    if (!parallel && !(depth > 0 && std::max(std::abs(p.x), std::abs(p.y)) <= widest_tangent)) return {};
    e.extend(p);
  }
  return e;
}

void set_window(LightView& view, uint32_t face, const Extent& extent, double scene_diagonal) {
  Face& f = view.faces[face];
  const bool parallel = view.light.w == 0;
  double reach = 0, scale[2];
  for (int c = 0; c < 2; ++c) reach = std::max({reach, std::abs(extent.lo[c]), std::abs(extent.hi[c])});
  // |q| / depth, of which the coordinates' rounding errors are a few parts in 1e7.
  const double bound = parallel ? scene_diagonal : 1 + 2 * reach;
  for (int c = 0; c < 2; ++c) {
    const double size = std::max(extent.hi[c] - extent.lo[c], 1e-5 * bound), pad = 1e-5 * size + 2e-6 * bound;
    const double middle = 0.5 * (extent.lo[c] + extent.hi[c]);
    f.window[c] = static_cast<float>(middle - 0.5 * size - pad);
    scale[c] = view.grid_size / (size + 2 * pad);
    f.window[c + 2] = static_cast<float>(scale[c]);
    f.slack[c] = static_cast<float>(1e-3 + 2e-6 * bound * scale[c]);
  }
  f.slack.z = static_cast<float>(bound);
}

}  // namespace penumbra::alias_free
