#include "techniques/depth_complexity_sampling/view_groups.h"

#include <algorithm>

#include "techniques/common/point_groups.h"

namespace penumbra::depth_complexity {
namespace {

std::size_t tiles_across(int pixels) {
  return static_cast<std::size_t>((pixels + tile_side - 1) / tile_side);
}

// Multiples of the groups' sizes, the largest first.
std::size_t unit_of(std::size_t n) {
  if (n <= small_group) return 0;
  return n > large_group ? large_group : n > middle_group ? middle_group : small_group;
}

}  // namespace

std::size_t tile_count(const ViewSamplesHost& view) {
  return tiles_across(view.width) * tiles_across(view.height);
}

std::size_t gather_tile(const ViewSamplesHost& view, std::size_t tile, const LightSpace& light,
                        const RayJudge& judge, ViewPoint* out, WorkCounts& counts) {
  const std::size_t across = tiles_across(view.width), width = static_cast<std::size_t>(view.width),
                    height = static_cast<std::size_t>(view.height);
  const std::size_t x0 = tile % across * tile_side, y0 = tile / across * tile_side;
  std::size_t count = 0;
  for (std::size_t y = y0; y < std::min(height, y0 + tile_side); ++y)
    for (std::size_t x = x0; x < std::min(width, x0 + tile_side); ++x) {
      const std::size_t pixel = y * width + x;
      if (view.triangle[pixel] == no_triangle) {
        judge.masks().write_whole(pixel, false);
        continue;
      }
      const HostMasks::Horizon horizon = judge.masks().horizon(pixel);
      const Vec3f p = light.from_world(view.origin[pixel].xyz());
      if (horizon == HostMasks::Horizon::below) {
        judge.masks().write_whole(pixel, true);
        continue;
      }
      if (!(p.z > 0)) {
        ++counts.view_samples, ++counts.traced;
        counts.extra_rays += judge.trace_each(pixel);
        continue;
      }
      out[count++] = {p.x, p.y, p.z, static_cast<uint32_t>(pixel), horizon == HostMasks::Horizon::across};
    }
  ViewPoint spare[tile_pixels];
  order_in_groups(out, spare, count, unit_of);
  return count;
}

}  // namespace penumbra::depth_complexity
