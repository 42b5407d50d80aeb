#include "techniques/common/shadow_maps/counters.h"

#include <limits>

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

// The layer that a pixel's view sample looks into; nothing where there is none, or it is turned away.
const FittedLayer* layer_at(const Fitted& fitted, const ViewSamplesHost& view, std::size_t i) {
  const Vec3d p(view.position[i].xyz()), n(view.geometric_normal[i].xyz());
  const Vec4d l = fitted.light.towards;
  if (view.triangle[i] == no_triangle || dot(n, l.xyz() - p * l.w) <= 0) return nullptr;
  return &fitted.layers[layer_of(fitted, view.position[i].w, p * l.w - l.xyz())];
}

double texel_in_pixels_at(const FittedLayer& layer, const Params& params, const Camera& camera,
                          const ViewSamplesHost& view, std::size_t i) {
  const double x = static_cast<double>(i % static_cast<std::size_t>(view.width)) + 0.5;
  const double y = static_cast<double>(i / static_cast<std::size_t>(view.width)) + 0.5;
  return texel_in_pixels(layer, params.map_size, camera, view.width, view.height, x, y,
                         Vec3d(view.position[i].xyz()), Vec3d(view.geometric_normal[i].xyz()));
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
    const FittedLayer* layer = layer_at(fitted, view, i);
    if (!layer) continue;
    const double size = texel_in_pixels_at(*layer, params, camera, view, i);
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

// The twelve edges of what a map covers, in the world.
static void add_frustum(const FittedLayer& layer, uint8_t kind, WorldLines& lines) {
  const Mat4d world_from_clip = inverse(layer.clip_from_world);
  const auto corner = [&](int k) {
    const Vec4d p =
        world_from_clip * Vec4d{(k & 1) ? 1.0 : -1.0, (k & 2) ? 1.0 : -1.0, (k & 4) ? 1.0 : 0.0, 1};
    return Vec4f{static_cast<float>(p.x / p.w), static_cast<float>(p.y / p.w), static_cast<float>(p.z / p.w),
                 1};
  };
  for (int a = 0; a < 8; ++a)
    for (const int bit : {1, 2, 4})
      if (!(a & bit)) lines.segments.push_back({corner(a), corner(a | bit), kind});
}

std::vector<Illustration> illustrate(const Params& params, const Fitted& fitted, const RenderInput& last) {
  if (!last.view_samples) return {};
  const ViewSamplesHost& view = last.view_samples->host();
  const Camera& camera = last.scene_case->frame->camera;
  PixelFigures texels{std::vector<float>(view.pixel_count(), std::numeric_limits<float>::quiet_NaN())};
  PixelClasses maps{std::vector<uint8_t>(view.pixel_count(), no_class), {}};
  WorldLines frusta;
  for (std::size_t k = 0; k < fitted.layers.size(); ++k) {
    maps.names.push_back((fitted.six_faces ? "face " : "cascade ") + std::to_string(k + 1));
    // A logarithmic map's own y is no projective map, and has no frustum of straight edges.
    if (fitted.layers[k].used && fitted.layers[k].log.scale == 0)
      add_frustum(fitted.layers[k], static_cast<uint8_t>(k), frusta);
  }
  frusta.kinds = maps.names;
  for (std::size_t i = 0; i < view.pixel_count(); ++i) {
    const FittedLayer* layer = layer_at(fitted, view, i);
    if (!layer) continue;
    texels.values[i] = static_cast<float>(texel_in_pixels_at(*layer, params, camera, view, i));
    maps.values[i] = static_cast<uint8_t>(layer - fitted.layers.data());
  }
  std::vector<Illustration> shown{
      {"texel_size", "Side of a depth map's texel at each view sample, in pixels", std::move(texels)}};
  if (fitted.layers.size() > 1)
    shown.push_back({"maps_over_scene", "Which depth map each view sample looks into", std::move(maps)});
  if (!frusta.segments.empty())
    shown.push_back({"map_frusta", "What each depth map covers", std::move(frusta)});
  return shown;
}

}  // namespace penumbra::shadow_map
