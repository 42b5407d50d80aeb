// Light samples: one set per (light, size, pattern, seed), the same for all techniques, so that masks can be
// compared bit by bit.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/light.h"

namespace penumbra {

enum class LightPattern { regular, jittered, halton };

struct LightSampleRequest {
  int width = 16, height = 16;  // mask_size; used when count == 0
  int count = 0;                // light_samples: any n >= 1, in place of width x height
  LightPattern pattern = LightPattern::regular;
  uint32_t seed = 1;
};

// Sample i of a w x h set is column i % w, row i / w; column s = (i % w + 0.5) / w along edge_u (regular).
// Bit i of word i / 32 of a mask belongs to sample i.
struct LightSamples {
  std::vector<Vec4f> points;   // w = 1: position; w = 0: unit direction towards a light at infinity
  std::vector<float> weights;  // sum 1; all equal but for textured lights
  int width = 0, height = 0;   // 0 x 0 when the set is not a grid in a rectangle's plane
  bool uniform_weights = true;
  int count() const { return static_cast<int>(points.size()); }
  int mask_words() const { return (count() + 31) / 32; }
};

// Point, directional and spot lights (and any light of size 0) give one sample. A `count` or a pattern other
// than regular gives no grid (width = height = 0) but a textured rectangle keeps it. A sphere is sampled over
// its volume.
LightSamples make_light_samples(const Light& light, const LightSampleRequest& request);

// `n` low-discrepancy samples (scrambled by seed) over the light, for the converged reference.
LightSamples make_reference_samples(const Light& light, int n, uint32_t seed);

}  // namespace penumbra
