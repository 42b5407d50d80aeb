#include "run/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/parallel.h"

namespace penumbra::run {
namespace {

nlohmann::json or_null(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json zone(const ZoneErrors& z) {
  // The mean over no pixel has no value; 0 would read as "no error".
  if (z.pixels == 0) return {{"pixels", 0}, {"mae", nullptr}, {"bias", nullptr}};
  return {{"pixels", z.pixels}, {"mae", z.mae}, {"bias", z.bias}};
}

Vec3f towards_light(const Light& light, Vec3f p) {
  if (light.kind == LightKind::directional) return -light.direction;
  return normalize(light.center - p);
}

// The picture's error must not come from pixels that nobody answers for.
std::vector<float> with_reference_elsewhere(std::span<const float> visibility,
                                            std::span<const float> reference,
                                            std::span<const uint8_t> evaluated) {
  std::vector<float> v(reference.begin(), reference.end());
  for (std::size_t i = 0; i < v.size(); ++i)
    if (evaluated[i]) v[i] = visibility[i];
  return v;
}

}  // namespace

std::vector<Vec3f> shade(const ViewSamplesHost& view, const Frame& frame, std::span<const float> visibility,
                         std::span<const float> cosines) {
  std::vector<Vec3f> picture(view.pixel_count());
  const Geometry& g = frame.geometry;
  parallel_for(picture.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (view.triangle[i] == no_triangle) continue;
      const Vec3f l = towards_light(frame.light, view.position[i].xyz());
      const float lambert =
          cosines.empty() ? std::max(0.0f, dot(view.shading_normal[i].xyz(), l)) : cosines[i];
      picture[i] = g.instance_albedo[g.triangle_instance[view.triangle[i]]] * (lambert * visibility[i]);
    }
  });
  return picture;
}

std::vector<uint8_t> evaluated_pixels(const MatchedReference& matched, std::span<const uint8_t> claimed) {
  std::vector<uint8_t> evaluated = matched.evaluated;
  for (std::size_t i = 0; i < claimed.size() && i < evaluated.size(); ++i)
    evaluated[i] = evaluated[i] && claimed[i];
  return evaluated;
}

void finish_output(Output& output, std::span<const uint8_t> evaluated, int width) {
  const auto w = static_cast<std::size_t>(width);
  const std::size_t words = output.mask.size() / std::max<std::size_t>(output.visibility.size(), 1);
  for (std::size_t i = 0; i < output.visibility.size(); ++i) {
    if (!evaluated[i]) {
      output.visibility[i] = 1;
      std::fill_n(output.mask.begin() + static_cast<std::ptrdiff_t>(i * words), words, 0U);
    } else if (!std::isfinite(output.visibility[i])) {
      throw PointError(fmt::format("the visibility of pixel ({}, {}) is {}: not written, or not a number.",
                                   i % w, i / w, output.visibility[i]));
    }
  }
}

nlohmann::json matched_metrics(const Output& output, std::span<const float> truth, int light_samples,
                               const std::optional<MaskMismatch>& bits, std::span<const uint8_t> evaluated,
                               int width, int height) {
  const std::vector<float> reference(truth.begin(), truth.end());
  const std::vector<uint8_t> counted(evaluated.begin(), evaluated.end());
  const ImageErrors e =
      image_errors({width, height, reference, counted}, {width, height, output.visibility, counted});
  std::size_t pixels = 0, off = 0;
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    if (!evaluated[i]) continue;
    ++pixels;
    // Half of the smallest step that one sample makes tells a different mask from a different rounding of its
    // sum.
    off += std::abs(output.visibility[i] - truth[i]) > 0.5f / static_cast<float>(light_samples);
  }
  nlohmann::json j = {
      {"mae", or_null(e.mae)},
      {"max", or_null(e.max)},
      {"evaluated_pixels", pixels},
      {"pixels_off", pixels ? nlohmann::json(double(off) / double(pixels)) : nlohmann::json()},
      {"mask_bit_mismatch", nullptr}};
  if (!bits) return j;
  j["mask_bit_mismatch"] = bits->bits ? nlohmann::json(bits->mask_bit_mismatch()) : nlohmann::json();
  j["mask_bits_off"] = bits->bits_off;
  j["pixels_off"] =
      bits->pixels ? nlohmann::json(double(bits->pixels_off) / double(bits->pixels)) : nlohmann::json();
  return j;
}

void Accumulation::add(Output& output, const MatchedReference& matched, const LightSamples& samples,
                       int width) {
  const std::vector<uint8_t> evaluated = evaluated_pixels(matched, output.claimed);
  finish_output(output, evaluated, width);
  if (frames_++ == 0) {
    evaluated_ = evaluated;
    visibility_.assign(evaluated.size(), 0), truth_.assign(evaluated.size(), 0);
  }
  for (std::size_t i = 0; i < evaluated.size(); ++i) {
    evaluated_[i] = evaluated_[i] && evaluated[i];
    visibility_[i] += double(output.visibility[i]), truth_[i] += double(matched.visibility[i]);
  }
  light_samples_ += samples.count();
  if (output.mask.empty()) return;
  const MaskMismatch m =
      mask_mismatch(matched.mask, output.mask, samples.mask_words(), samples.count(), evaluated);
  if (!bits_) bits_.emplace();
  bits_->bits += m.bits, bits_->bits_off += m.bits_off;
  bits_->pixels += m.pixels, bits_->pixels_off += m.pixels_off;
}

void Accumulation::take_mean(Output& output) const {
  for (std::size_t i = 0; i < visibility_.size(); ++i)
    output.visibility[i] = evaluated_[i] ? static_cast<float>(visibility_[i] / frames_) : 1;
}

std::vector<float> Accumulation::truth() const {
  std::vector<float> mean(truth_.size());
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = static_cast<float>(truth_[i] / frames_);
  return mean;
}

nlohmann::json converged_metrics(const Output& output, const ReferenceScene::Converged& converged,
                                 std::span<const uint8_t> evaluated, const ViewSamplesHost& view,
                                 const Frame& frame) {
  std::vector<uint8_t> both(evaluated.begin(), evaluated.end());
  for (std::size_t i = 0; i < both.size(); ++i) both[i] = both[i] && converged.evaluated[i];
  const ScalarImage reference{view.width, view.height, converged.visibility, both};
  const ScalarImage test{view.width, view.height, output.visibility, both};
  const ImageErrors e = image_errors(reference, test);
  // Judged by its visibility: with the harness's cosine, whatever its own.
  const auto picture =
      shade(view, frame, with_reference_elsewhere(output.visibility, converged.visibility, both));
  const auto truth = shade(view, frame, converged.visibility);
  return {{"mae", or_null(e.mae)},
          {"rmse", or_null(e.rmse)},
          {"max", or_null(e.max)},
          {"psnr", or_null(e.psnr)},
          {"ssim", or_null(e.ssim)},
          {"flip", flip(truth, picture, view.width, view.height).mean},
          {"bias", or_null(e.bias)},
          {"acne", or_null(e.acne)},
          {"leak", or_null(e.leak)},
          {"evaluated_pixels", e.evaluated_pixels},
          {"reference_standard_error", converged.mean_standard_error},
          {"zones", {{"umbra", zone(e.umbra)}, {"penumbra", zone(e.penumbra)}, {"lit", zone(e.lit)}}}};
}

}  // namespace penumbra::run
