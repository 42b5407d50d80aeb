#include "techniques/soft_shadow_volume/area_light.h"

namespace penumbra::soft_shadow_volume {
namespace {

Vec4f with(Vec3f v, float w) { return {v.x, v.y, v.z, w}; }

Part part(const Light& light, int split, int column, int row) {
  const float n = static_cast<float>(split);
  const Vec3f u = light.edge_u / n, v = light.edge_v / n;
  const Vec3f center =
      light.at((static_cast<float>(column) + 0.5f) / n, (static_cast<float>(row) + 0.5f) / n);
  Part p;
  p.light.center = with(center, length(u + v) / 2);
  p.light.scale_u = with(u * (2 / dot(u, u)), 0), p.light.scale_v = with(v * (2 / dot(v, v)), 0);
  p.pivot = center + u * (0.5f * PIVOT_X) + v * (0.5f * PIVOT_Y);
  p.share = 1 / (n * n);
  return p;
}

}  // namespace

uint32_t shape_of(LightKind kind) {
  return kind == LightKind::sphere      ? SHAPE_DISC
         : kind == LightKind::rectangle ? SHAPE_RECTANGLE
                                        : SHAPE_POINT;
}

std::vector<Part> parts_of(const Light& light, int split) {
  std::vector<Part> parts;
  if (light.kind == LightKind::rectangle) {
    for (int row = 0; row < split; ++row)
      for (int column = 0; column < split; ++column) parts.push_back(part(light, split, column, row));
    return parts;
  }
  parts.resize(1);
  parts[0].light.center = with(light.center, light.radius);
  parts[0].pivot = light.center;  // a point light's is where it is
  if (light.kind == LightKind::sphere) parts[0].pivot += Vec3f{PIVOT_X, PIVOT_Y, PIVOT_X} * light.radius;
  return parts;
}

}  // namespace penumbra::soft_shadow_volume
