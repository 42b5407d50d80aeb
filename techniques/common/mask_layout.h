// How a mask of light samples is laid out while it is made, and the pass that hands it out.
#pragma once
#include "samples/light_samples.h"
#include "scene/light.h"

namespace penumbra {

// Layout of a mask while it is walked. A regular grid of light samples takes `pitch` bits per row; other sets
// one bit after the other.
struct MaskLayout {
  bool grid = false;
  bool infinite = false;  // samples are directions
  bool weighted = false;
  int columns = 1, rows = 1, pitch = 32;
  int samples = 1, words = 1;
  int mask_words = 1;                // words of the mask that is handed out
  PixelMove move = PixelMove::none;  // by which each pixel moves the samples
  bool clustered = false;            // walked in an order of its own, neighbours together
  bool packed = true;                // the walked mask is laid out as the one handed out
  bool operator==(const MaskLayout&) const = default;
};

// True when the samples are a columns x rows grid on the light's rectangle, grid_shift off the cells'
// centres.
bool is_regular_grid(const Light& light, const LightSamples& samples);
MaskLayout mask_layout(const Light& light, const LightSamples& samples);

}  // namespace penumbra
