// What an output is worth: held against the matched and the converged reference. The harness judges; a
// technique sees nothing of this.
#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "metrics/metrics.h"
#include "reference/reference.h"
#include "run/point_run.h"

namespace penumbra::run {

// The picture that FLIP and people look at: albedo * max(0, dot(Ns, direction to the light's centre)) * V,
// linear, and black where there is no view sample. The Lambert term is the same for all techniques.
std::vector<Vec3f> shade(const ViewSamplesHost& view, const Frame& frame, std::span<const float> visibility);

// Pixels that count: a view sample, at least one light sample above its horizon (as the matched reference
// found), and an answer claimed by the technique.
std::vector<uint8_t> evaluated_pixels(const MatchedReference& matched, std::span<const uint8_t> claimed);

// Pixels that are not evaluated get visibility 1 and an empty mask. Throws PointError, naming the pixel, for
// an evaluated one that is not finite.
void finish_output(Output& output, std::span<const uint8_t> evaluated, int width);

// "metrics_matched" of contract.md.
nlohmann::json matched_metrics(const Output& output, const MatchedReference& matched,
                               const LightSamples& samples, std::span<const uint8_t> evaluated, int width,
                               int height);

// "metrics" of contract.md, flicker apart. FLIP compares the shaded pictures over all pixels, as its authors
// define it; pixels that are not evaluated are equal in both.
nlohmann::json converged_metrics(const Output& output, const ReferenceScene::Converged& converged,
                                 std::span<const uint8_t> evaluated, const ViewSamplesHost& view,
                                 const Frame& frame);

}  // namespace penumbra::run
