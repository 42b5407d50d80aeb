#include "run/flicker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "core/parallel.h"

namespace penumbra::run {
namespace {

// Pixels with less than this share of a bilinear footprint are not part of it.
constexpr double least_weight = 1e-3;
constexpr PastPixels none = {no_pixel, no_pixel, no_pixel, no_pixel};

Vec3d point_before(const Geometry& g, uint32_t triangle, Vec2f barycentrics) {
  const double b = double(barycentrics.x), c = double(barycentrics.y);
  return Vec3d(g.corner(triangle, 0)) * (1 - b - c) + Vec3d(g.corner(triangle, 1)) * b +
         Vec3d(g.corner(triangle, 2)) * c;
}

class Past {
 public:
  Past(const ViewSamplesHost& before, const Frame& frame)
      : before_(before), clip_from_world_(frame.camera.clip_from_world(before.width, before.height)) {
    const double half = 0.5 * double(frame.camera.vertical_fov_degrees) * std::numbers::pi / 180;
    pixel_width_ = 2 * std::tan(half) / before.height;
  }

  // Pixels around the place of `point` that show the surface through it with this normal.
  PastPixels around(Vec3d point, Vec3d normal) const {
    PastPixels found = none;
    const Vec4d clip = clip_from_world_ * Vec4d{point.x, point.y, point.z, 1};
    if (!(clip.w > 0)) return none;
    const double x = (clip.x / clip.w * 0.5 + 0.5) * before_.width - 0.5;
    const double y = (clip.y / clip.w * 0.5 + 0.5) * before_.height - 0.5;
    if (!(x > -1 && y > -1 && x < before_.width && y < before_.height)) return none;
    const double left = std::floor(x), top = std::floor(y);
    for (int i = 0; i < 4; ++i) {
      const double column = left + (i & 1), row = top + (i >> 1);
      const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
      if (weight < least_weight) continue;
      if (column < 0 || row < 0 || column >= before_.width || row >= before_.height) return none;
      const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(before_.width) +
                         static_cast<std::size_t>(column);
      if (!same_surface(pixel, point, normal, clip.w * pixel_width_)) return none;
      found[static_cast<std::size_t>(i)] = static_cast<uint32_t>(pixel);
    }
    return found;
  }

 private:
  bool same_surface(std::size_t pixel, Vec3d point, Vec3d normal, double tolerance) const {
    if (before_.triangle[pixel] == no_triangle) return false;
    const Vec3d n(before_.geometric_normal[pixel].xyz()), to = point - Vec3d(before_.position[pixel].xyz());
    return dot(n, normal) > 0.7 && std::abs(dot(n, to)) < tolerance && std::abs(dot(normal, to)) < tolerance;
  }

  const ViewSamplesHost& before_;
  Mat4d clip_from_world_;
  double pixel_width_ = 0;  // at unit distance
};

}  // namespace

std::vector<PastPixels> past_pixels(const ViewSamplesHost& now, const ViewSamplesHost& before,
                                    const Frame& frame_before) {
  std::vector<PastPixels> pixels(now.pixel_count());
  const Past past(before, frame_before);
  parallel_for(pixels.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      pixels[i] = none;
      if (now.triangle[i] == no_triangle) continue;
      const Vec3d p = point_before(frame_before.geometry, now.triangle[i], now.barycentrics[i]);
      pixels[i] = past.around(p, Vec3d(now.geometric_normal[i].xyz()));
    }
  });
  return pixels;
}

std::vector<PastPixels> same_pixels(std::size_t count) {
  std::vector<PastPixels> pixels(count);
  for (std::size_t i = 0; i < count; ++i)
    pixels[i] = {static_cast<uint32_t>(i), no_pixel, no_pixel, no_pixel};
  return pixels;
}

std::vector<float> signed_error(std::span<const float> visibility, std::span<const float> reference,
                                std::span<const uint8_t> evaluated) {
  std::vector<float> error(visibility.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < error.size(); ++i)
    if (evaluated[i]) error[i] = visibility[i] - reference[i];
  return error;
}

nlohmann::json flicker(std::span<const float> error, std::span<const float> error_before,
                       std::span<const PastPixels> past) {
  double sum = 0;
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < error.size() && i < past.size(); ++i) {
    if (std::isnan(error[i])) continue;
    float lo = std::numeric_limits<float>::infinity(), hi = -lo;
    bool known = false;
    for (const uint32_t pixel : past[i]) {
      if (pixel >= error_before.size()) continue;
      known = !std::isnan(error_before[pixel]);
      if (!known) break;
      lo = std::min(lo, error_before[pixel]), hi = std::max(hi, error_before[pixel]);
    }
    if (!known) continue;
    sum += std::max({double(lo) - double(error[i]), double(error[i]) - double(hi), 0.0});
    ++pixels;
  }
  return pixels ? nlohmann::json(sum / static_cast<double>(pixels)) : nlohmann::json();
}

}  // namespace penumbra::run
