// A light as wedges are made for it: whole, or cut into parts.
#pragma once
#include <vector>

#include "scene/light.h"
#include "techniques/soft_shadow_volume/shaders/shared.h"

namespace penumbra::soft_shadow_volume {

// SHAPE_* of a light kind that the technique takes.
uint32_t shape_of(LightKind kind);

struct Part {
  AreaLight light{};
  Vec3f pivot;      // see shared.h
  float share = 1;  // of the whole light's area
};

// Parts of a rectangle row by row; one part of any other light.
std::vector<Part> parts_of(const Light& light, int split);

// The textures of all parts below each other, as shaders/texture.glsl reads them. Parts cut texels: each has
// as many texels as the whole light. Lights that have none get one texel, which is not read.
struct LightTexture {
  uint32_t width = 1, height = 1;
  std::vector<Vec4f> texels{{}};
};
LightTexture texture_of(const Light& light, int split);

}  // namespace penumbra::soft_shadow_volume
