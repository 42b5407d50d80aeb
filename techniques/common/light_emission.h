// A light as hard-shadow techniques see it: one point or direction, and where it sends light. Area lights are
// seen from their centre.
#pragma once
#include "techniques/common/light_frame.h"

namespace penumbra {

struct LightEmission {
  Vec4f towards;   // position, 1; or the unit direction towards a light at infinity, 0
  Vec4f emission;  // axis, and cosine of the half angle about it in which light leaves (-1: everywhere)
  bool at_infinity() const { return towards.w == 0; }
};

inline LightEmission light_emission(const Light& light) {
  const LightPoint p = light_point(light);
  return {p.device_towards(), p.device_emission()};
}

// From one of the light's samples.
inline LightEmission light_emission(const Light& light, Vec4f sample) {
  return {sample, light_point(light).device_emission()};
}

}  // namespace penumbra
