#include "techniques/alias_free_shadow_map/light_view.h"

#include <algorithm>

namespace penumbra::alias_free {
namespace {

Vec4f with_w(Vec3d v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

Face face_of(const LightFrame& f) {
  return {with_w(f.right, 0), with_w(f.down, 0), with_w(f.forward, 0), {}, {}};
}

}  // namespace

Extent decode(const SampleBounds& b) {
  Extent e;
  e.whole = b.outside != 0;
  if (b.lo[0] == 0xffffffffU) return e;
  for (int c = 0; c < 3; ++c) e.lo[c] = from_ordered(b.lo[c]), e.hi[c] = from_ordered(~b.hi[c]);
  return e;
}

LightView begin_view(const LightPoint& light, const Box& scene) {
  LightView v{};
  v.light = light.device_towards();
  v.center = light.at_infinity() ? with_w(Vec3d(scene.center()), 0) : v.light;
  v.emission = light.device_emission();
  return v;
}

void aim(LightView& view, const LightPoint& light, Vec3d towards, Vec3d hint) {
  Vec3d forward = light.at_infinity() || light.spot ? light.axis : towards;
  if (!(length(forward) > 0)) forward = {0, -1, 0};
  view.face_count = 1;
  view.faces[0] = face_of(light_frame(forward, hint));
}

void aim_cube(LightView& view) {
  view.face_count = most_faces;
  for (int f = 0; f < static_cast<int>(most_faces); ++f) view.faces[f] = face_of(cube_frame(f));
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
