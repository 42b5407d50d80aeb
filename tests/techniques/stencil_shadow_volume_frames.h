// Frames of the tests of stencil_shadow_volume.
#pragma once
#include "stencil_planar_stage.h"
#include "techniques/stencil_shadow_volume/stencil_shadow_volume.h"

namespace penumbra::test {

inline const TechniqueInfo info = stencil_shadow_volume_technique();

inline ParamValues params(const std::string& variant, const std::string& extrusion = "silhouette",
                          const std::string& casters = "all") {
  return {{"variant", variant}, {"extrusion", extrusion}, {"casters", casters}};
}

inline Frame box_on_ground(const Light& light) {
  Frame f;
  testing::add_ground(f.geometry, 6);
  testing::add_box(f.geometry, {-1, 0.5f, -1}, {1, 1.5f, 1});
  f.light = light;
  f.camera = camera_at({2, 4, 6}, {0, 0, 0});
  return f;
}

// 256 triangles over each other above the ground.
inline Frame pile(const Light& light) {
  Frame f;
  testing::add_ground(f.geometry, 6);
  for (int i = 0; i < 256; ++i) {
    const float y = 1 + float(i) * 0.005f;
    testing::add_triangle(f.geometry, {-1, y, -1}, {0, y, 2}, {1, y, -1});
  }
  f.light = light, f.camera = camera_at({4, 5, 5}, {0, 0, 0});
  return f;
}

}  // namespace penumbra::test
