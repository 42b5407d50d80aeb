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
  return kind == LightKind::sphere               ? SHAPE_DISC
         : kind == LightKind::rectangle          ? SHAPE_RECTANGLE
         : kind == LightKind::textured_rectangle ? SHAPE_TEXTURE
                                                 : SHAPE_POINT;
}

std::vector<Part> parts_of(const Light& light, int split) {
  std::vector<Part> parts;
  if (light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle) {
    for (int row = 0; row < split; ++row)
      for (int column = 0; column < split; ++column) {
        parts.push_back(part(light, split, column, row));
        parts.back().light.scale_u.w = static_cast<float>((row * split + column) * light.texture_height);
        parts.back().light.scale_v.w = static_cast<float>(light.texture_height);
      }
    return parts;
  }
  parts.resize(1);
  parts[0].light.center = with(light.center, light.radius);
  parts[0].pivot = light.center;  // a point light's is where it is
  if (light.kind == LightKind::sphere) parts[0].pivot += Vec3f{PIVOT_X, PIVOT_Y, PIVOT_X} * light.radius;
  return parts;
}

// One row of one part: weights over their mean, and their integrals.
static void add_row(const Light& light, int split, int first_column, int row, double mean,
                    LightTexture& out) {
  const double cell = 2.0 / light.texture_width;
  double f = 0, integral = 0;
  for (int i = 0; i < light.texture_width; ++i) {
    const int at = row * light.texture_width + (first_column + i) / split;
    const double w = mean > 0 ? double(light.weights[static_cast<std::size_t>(at)]) / mean : 1;
    out.texels.push_back({static_cast<float>(f), static_cast<float>(w), static_cast<float>(integral), 0});
    integral += (f + 0.5 * w * cell) * cell, f += w * cell;
  }
}

LightTexture texture_of(const Light& light, int split) {
  if (light.kind != LightKind::textured_rectangle) return {};
  LightTexture out;
  out.texels.clear();
  out.width = static_cast<uint32_t>(light.texture_width);
  out.height = static_cast<uint32_t>(light.texture_height * split * split);
  double mean = 0;
  for (const float w : light.weights) mean += double(w) / double(light.weights.size());
  for (int part_row = 0; part_row < split; ++part_row)
    for (int part_column = 0; part_column < split; ++part_column)
      for (int j = 0; j < light.texture_height; ++j)
        add_row(light, split, part_column * light.texture_width,
                (part_row * light.texture_height + j) / split, mean, out);
  return out;
}

}  // namespace penumbra::soft_shadow_volume
