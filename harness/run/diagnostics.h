// What a technique shows of itself, drawn over the scene.
#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "image/image.h"
#include "samples/view_samples.h"
#include "technique/illustration.h"

namespace penumbra::run {

// The scene that figures and lines are drawn over: its picture, dimmed and grey, and what it hides.
struct Backdrop {
  Rgb8Image picture;
  const ViewSamplesHost* view = nullptr;
  const Camera* camera = nullptr;
};
// From a shaded picture, linear.
Backdrop backdrop(std::span<const Vec3f> shaded, const ViewSamplesHost& view, const Camera& camera);

struct Drawn {
  Rgb8Image picture;
  int width = 0, height = 0;
  std::vector<float> figures;  // as they came, for the EXR; empty where there are none
  nlohmann::json legend;       // {"name", "title", "kind", ...}: see results/README.md
};
// Throws PointError, naming the picture, when its size is not that of the view or figures are missing.
Drawn draw(const Illustration& illustration, const Backdrop& backdrop);

// Umbra (V <= 0), penumbra and lit (V >= 1) of a reference, over evaluated pixels.
Illustration zones(std::span<const float> visibility, std::span<const uint8_t> evaluated);

}  // namespace penumbra::run
