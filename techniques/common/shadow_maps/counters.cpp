#include "techniques/common/shadow_maps/counters.h"

namespace penumbra::shadow_map {
namespace {

std::size_t layer_of(const Fitted& fitted, double view_depth, Vec3d from_light) {
  if (fitted.six_faces) {
    const Vec3d a{std::abs(from_light.x), std::abs(from_light.y), std::abs(from_light.z)};
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return static_cast<std::size_t>(2 * axis + (from_light[axis] < 0 ? 1 : 0));
  }
  std::size_t layer = 0;
  while (layer + 1 < fitted.layers.size() && view_depth >= fitted.layers[layer].view_hi) ++layer;
  return layer;
}

Vec2d texel_step(const FittedLayer& layer, double map_size, Vec3d p, Vec3d q) {
  const Vec3d a = map_point(layer, p), b = map_point(layer, q);
  return {0.5 * map_size * (b.x - a.x), 0.5 * map_size * (b.y - a.y)};
}

}  // namespace

double texel_in_pixels(const FittedLayer& layer, double map_size, const Camera& camera, int width, int height,
                       double pixel_x, double pixel_y, Vec3d position, Vec3d normal) {
  const Vec3d eye(camera.eye);
  const double plane = dot(normal, position - eye);
  // A hundredth of a pixel: the map is differentiated, not stepped over.
  constexpr double h = 0.01;
  const auto hit = [&](double x, double y) {
    const Vec3d d = camera.ray_direction(x, y, width, height);
    return eye + d * (plane / dot(normal, d));
  };
  const Vec3d p = hit(pixel_x, pixel_y);
  const Vec2d u = texel_step(layer, map_size, p, hit(pixel_x + h, pixel_y));
  const Vec2d v = texel_step(layer, map_size, p, hit(pixel_x, pixel_y + h));
  return h / std::sqrt(std::abs(u.x * v.y - u.y * v.x));
}

Counters count(const Params& params, const Fitted& fitted, uint64_t map_bytes, const RenderInput& last) {
  Counters out;
  if (!last.view_samples) return out;
  out["map_bytes"] = static_cast<double>(map_bytes);
  out["layers"] = static_cast<double>(fitted.layers.size());
  double warped = 0;
  for (const FittedLayer& l : fitted.layers) warped += l.warped ? 1 : 0;
  out["warped_layers"] = warped;
  if (params.cascades > 1) out["cascade_splits"] = fitted.splits;
  out["six_faces"] = fitted.six_faces ? 1.0 : 0.0;
  const ViewSamplesHost& view = last.view_samples->host();
  const Camera& camera = last.scene_case->frame->camera;
  std::vector<double> sizes;
  for (std::size_t i = 0; i < view.pixel_count(); ++i) {
    const Vec3d p(view.position[i].xyz()), n(view.geometric_normal[i].xyz());
    const Vec4d l = fitted.light.towards;
    if (view.triangle[i] == no_triangle || dot(n, l.xyz() - p * l.w) <= 0) continue;
    const FittedLayer& layer = fitted.layers[layer_of(fitted, view.position[i].w, p * l.w - l.xyz())];
    const double x = static_cast<double>(i % static_cast<std::size_t>(view.width)) + 0.5;
    const double y = static_cast<double>(i / static_cast<std::size_t>(view.width)) + 0.5;
    const double size = texel_in_pixels(layer, params.map_size, camera, view.width, view.height, x, y, p, n);
    if (std::isfinite(size)) sizes.push_back(size);
  }
  if (sizes.empty()) return out;
  std::sort(sizes.begin(), sizes.end());
  double sum = 0;
  for (double s : sizes) sum += s;
  const auto at = [&](double q) {
    return sizes[static_cast<std::size_t>(q * static_cast<double>(sizes.size() - 1))];
  };
  out["texel_to_pixel_mean"] = sum / static_cast<double>(sizes.size());
  out["texel_to_pixel_median"] = at(0.5);
  out["texel_to_pixel_p95"] = at(0.95);
  const auto coarse = sizes.end() - std::upper_bound(sizes.begin(), sizes.end(), 1.0);
  out["undersampled_share"] = static_cast<double>(coarse) / static_cast<double>(sizes.size());
  return out;
}

}  // namespace penumbra::shadow_map
