// ZP+: how the scene looks from the light, on the camera's near plane [Hornus2005].
#pragma once
#include <optional>

#include "core/vec.h"
#include "scene/camera.h"

namespace penumbra::shadow_volume {

// Clip space whose pixels are those of the camera's near plane, and in which a triangle covers a pixel when
// it lies between that pixel's point of the near plane and the light. `light`: position, 1; or the unit
// direction towards a light at infinity, 0. Nothing when the light lies in the near plane, where the view
// from it degenerates.
std::optional<Mat4d> near_plane_from_light(const Camera& camera, int width, int height, Vec4d light,
                                           const Box& bounds);

}  // namespace penumbra::shadow_volume
