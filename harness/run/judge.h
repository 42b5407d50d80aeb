// What an output is worth: held against the matched and the converged reference. The harness judges; a
// technique sees nothing of this.
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "metrics/metrics.h"
#include "reference/reference.h"
#include "run/point_run.h"

namespace penumbra::run {

// The picture that FLIP and people look at: albedo * max(0, dot(Ns, direction to the light's centre)) * V,
// linear, and black where there is no view sample. The cosine is the same for all techniques, but for those
// that hand out `cosines` of their own.
std::vector<Vec3f> shade(const ViewSamplesHost& view, const Frame& frame, std::span<const float> visibility,
                         std::span<const float> cosines = {});

// Pixels that count: a view sample, at least one light sample above its horizon (as the matched reference
// found), and an answer claimed by the technique.
std::vector<uint8_t> evaluated_pixels(const MatchedReference& matched, std::span<const uint8_t> claimed);

// Pixels that are not evaluated get visibility 1 and an empty mask. Throws PointError, naming the pixel, for
// an evaluated one that is not finite.
void finish_output(Output& output, std::span<const uint8_t> evaluated, int width);

// "metrics_matched" of contract.md. `light_samples`: how many the visibility is the mean of. `bits`: how the
// masks differ; nothing for techniques that are not sampled.
nlohmann::json matched_metrics(const Output& output, std::span<const float> truth, int light_samples,
                               const std::optional<MaskMismatch>& bits, std::span<const uint8_t> evaluated,
                               int width, int height);

// The frames of an accumulation, one after the other, each against its own truth: the mean of visibilities
// that are evaluated in all of them, and the bits of all masks. Of one frame: the frame itself.
class Accumulation {
 public:
  // Finishes `output` (finish_output) and adds it. Throws PointError as that does.
  void add(Output& output, const MatchedReference& matched, const LightSamples& samples, int width);
  // The last output with the mean visibility; its mask is the last frame's.
  void take_mean(Output& output) const;

  const std::vector<uint8_t>& evaluated() const { return evaluated_; }
  std::vector<float> truth() const;
  int light_samples() const { return light_samples_; }
  const std::optional<MaskMismatch>& bits() const { return bits_; }

 private:
  int frames_ = 0, light_samples_ = 0;
  std::vector<double> visibility_, truth_;
  std::vector<uint8_t> evaluated_;
  std::optional<MaskMismatch> bits_;
};

// "metrics" of contract.md, flicker apart. FLIP compares the shaded pictures over all pixels, as its authors
// define it; pixels that are not evaluated are equal in both.
nlohmann::json converged_metrics(const Output& output, const ReferenceScene::Converged& converged,
                                 std::span<const uint8_t> evaluated, const ViewSamplesHost& view,
                                 const Frame& frame);

}  // namespace penumbra::run
