// What a light means to the room: the space to work in, its samples there, its bounds.
#pragma once
#include "samples/light_samples.h"
#include "scene/scene.h"
#include "techniques/common/mask_layout.h"
#include "techniques/sample_based_soft/shaders/shared.h"

namespace penumbra::sample_based_soft {

struct LightSetup {
  MaskLayout layout;
  bool ball = false;  // bounded by an ellipsoid (spheres, volumes), else by a rectangle
  float radius = 0;   // working space: no light sample is farther from the centre
  float slack = 0;    // world: more than |P' - P|
  FrameConstants constants{};
  std::vector<Vec4f>
      samples;  // world, then working space; clustered: then the clusters' boxes, see mask_any.glsl
  std::vector<uint32_t> places;  // clustered: of each light sample among them
};

// `table`: masks are looked up, so regular grids get no layout of their own.
LightSetup light_setup(const Light& light, const LightSamples& samples, const Box& bounds, bool table);

// Light outside the bounds of an instance cannot be inside of it.
bool outside(const Box& light, const Box& instance);
Box sample_box(const LightSamples& samples);

}  // namespace penumbra::sample_based_soft
