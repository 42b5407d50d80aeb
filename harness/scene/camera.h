// Pinhole cameras.
#pragma once
#include <string>

#include "core/vec.h"

namespace penumbra {

struct Camera {
  std::string name;
  Vec3f eye{0, 0, 5}, target{0, 0, 0}, up{0, 1, 0};
  float vertical_fov_degrees = 45;  // (0, 180)
  float near_plane = 0.01f;         // > 0, scene units; the far plane is at infinity

  // Unit vectors: right, up, forward (into the picture).
  struct Basis {
    Vec3d right, up, forward;
  };
  Basis basis() const;
  // Vulkan clip space (y down, z in [0, w]) with reversed depth: depth = near / view distance along forward,
  // so 1 at the near plane and 0 at infinity. Compare with GREATER, clear to 0.
  Mat4d clip_from_world(int width, int height) const;
  // The ray through pixel coordinates (x, y), pixel centres at +0.5, row 0 on top. Not normalised: forward
  // component 1.
  Vec3d ray_direction(double x, double y, int width, int height) const;
  bool operator==(const Camera&) const = default;
};

}  // namespace penumbra
