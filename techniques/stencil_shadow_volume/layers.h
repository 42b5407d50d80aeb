// How many volumes can lie over each other: an upper bound, so that no count wraps unseen.
#pragma once
#include <cstdint>

#include "scene/scene.h"

namespace penumbra::shadow_volume {

// No ray from the light (position, 1; or the direction towards a light at infinity, 0) meets more triangles
// than this. The search ends where it has proved `enough`; a result above `enough` may be far above the
// truth, or it.
uint32_t most_layers(const Geometry& geometry, Vec4d light, uint32_t enough);

}  // namespace penumbra::shadow_volume
