// A light as hard-shadow techniques see it: one point or direction, and where it sends light. Area lights are
// seen from their centre.
#pragma once
#include <cmath>
#include <numbers>

#include "core/vec.h"
#include "scene/light.h"

namespace penumbra {

struct LightEmission {
  Vec4f towards;   // position, 1; or the unit direction towards a light at infinity, 0
  Vec4f emission;  // axis, and cosine of the half angle about it in which light leaves (-1: everywhere)
  bool at_infinity() const { return towards.w == 0; }
};

inline LightEmission light_emission(const Light& light) {
  const Vec3f d = normalize(light.direction), c = light.center;
  switch (light.kind) {
    case LightKind::directional:
      return {{-d.x, -d.y, -d.z, 0}, {d.x, d.y, d.z, -1}};
    case LightKind::spot:
      return {
          {c.x, c.y, c.z, 1},
          {d.x, d.y, d.z, static_cast<float>(std::cos(double{light.cone_degrees} * std::numbers::pi / 180))}};
    case LightKind::rectangle:
    case LightKind::textured_rectangle:
      return {{c.x, c.y, c.z, 1}, {d.x, d.y, d.z, 0}};
    default:
      return {{c.x, c.y, c.z, 1}, {d.x, d.y, d.z, -1}};
  }
}

}  // namespace penumbra
