#include "techniques/depth_complexity_sampling/view_groups.h"

#include <algorithm>

namespace penumbra::depth_complexity {
namespace {

std::size_t tiles_across(int pixels) {
  return static_cast<std::size_t>((pixels + tile_side - 1) / tile_side);
}

// Cuts at multiples of the group sizes, so that groups are full but for the last.
void order(ViewPoint* p, std::size_t n) {
  if (n <= small_group) return;
  const std::size_t unit = n > large_group ? large_group : n > middle_group ? middle_group : small_group;
  const std::size_t half = std::max(unit, (n / 2 + unit / 2) / unit * unit);
  float lo[3] = {p->x, p->y, p->z}, hi[3] = {p->x, p->y, p->z};
  for (std::size_t i = 1; i < n; ++i) {
    const float v[3] = {p[i].x, p[i].y, p[i].z};
    for (int k = 0; k < 3; ++k) lo[k] = std::min(lo[k], v[k]), hi[k] = std::max(hi[k], v[k]);
  }
  const float size[3] = {hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]};
  const auto cut = [&](float ViewPoint::*axis) {
    std::nth_element(p, p + half, p + n,
                     [axis](const ViewPoint& a, const ViewPoint& b) { return a.*axis < b.*axis; });
  };
  if (size[0] >= size[1] && size[0] >= size[2])
    cut(&ViewPoint::x);
  else
    size[1] >= size[2] ? cut(&ViewPoint::y) : cut(&ViewPoint::z);
  order(p, half);
  order(p + half, n - half);
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
  order(out, count);
  return count;
}

}  // namespace penumbra::depth_complexity
