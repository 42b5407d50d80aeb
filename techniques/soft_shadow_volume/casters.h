// Which triangles cast: those of closed surfaces. An open surface may only be one that shadows nothing, such
// as a floor under everything.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace penumbra::soft_shadow_volume {

struct Casters {
  std::vector<uint32_t> casts;  // per triangle
  std::string refusal;          // why the scene cannot be done; empty when it can
};

Casters find_casters(const Geometry& geometry, const Adjacency& adjacency, const Light& light);

}  // namespace penumbra::soft_shadow_volume
