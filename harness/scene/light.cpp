#include "scene/light.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace penumbra {

const char* to_string(LightKind kind) {
  switch (kind) {
    case LightKind::point:
      return "point";
    case LightKind::directional:
      return "directional";
    case LightKind::spot:
      return "spot";
    case LightKind::rectangle:
      return "rectangle";
    case LightKind::sphere:
      return "sphere";
    case LightKind::textured_rectangle:
      return "textured_rectangle";
    case LightKind::volume:
      return "volume";
  }
  return "unknown";
}

float Light::size() const {
  switch (kind) {
    case LightKind::rectangle:
    case LightKind::textured_rectangle:
      return length(edge_u + edge_v);
    case LightKind::sphere:
      return 2 * radius;
    default:
      return 0;
  }
}

Light with_size(const Light& light, float size) {
  if (!std::isfinite(size) || size < 0)
    throw InputError(fmt::format("light '{}': size {} is not a length >= 0", light.name, size));
  if (size == 0) {
    Light point = light;
    if (!light.is_area()) return point;
    point.kind = LightKind::point;
    point.edge_u = point.edge_v = {};
    point.radius = 0;
    point.texture_width = point.texture_height = 0;
    point.weights.clear();
    point.points.clear();
    return point;
  }
  const float own = light.size();
  if (!(own > 0))
    throw InputError(fmt::format("light '{}' is a {} light, which has no size (asked for {})", light.name,
                                 to_string(light.kind), size));
  Light scaled = light;
  const float factor = size / own;
  scaled.edge_u = light.edge_u * factor;
  scaled.edge_v = light.edge_v * factor;
  scaled.radius = light.radius * factor;
  return scaled;
}

}  // namespace penumbra
