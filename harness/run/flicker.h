// Temporal change of the error, which is what the eye sees crawl: the error of each view sample against the
// error that the same point of the same surface had a frame before, wherever in the picture it was then.
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "samples/view_samples.h"
#include "scene/scene.h"

namespace penumbra::run {

// Pixels of the frame before around the place where a pixel's view sample was then; no_pixel where there is
// none.
inline constexpr uint32_t no_pixel = 0xffffffffU;
using PastPixels = std::array<uint32_t, 4>;

// For each pixel: its view sample's triangle and barycentrics give the point in the frame before, that
// frame's camera the place in its picture, and the pixels whose centres are around it its past. There is none
// unless all of them show the same surface: their points lie within a pixel's width of each other's plane and
// are turned the same way. Where nothing moved, a pixel is its own past.
std::vector<PastPixels> past_pixels(const ViewSamplesHost& now, const ViewSamplesHost& before,
                                    const Frame& frame_before);
// Where neither camera nor geometry moved.
std::vector<PastPixels> same_pixels(std::size_t count);

// V - R per pixel; NaN marks pixels that are not evaluated.
std::vector<float> signed_error(std::span<const float> visibility, std::span<const float> reference,
                                std::span<const uint8_t> evaluated);

// Mean, over pixels that have a past and were evaluated in both frames, of how far the signed error lies
// outside the range of the errors at the past pixels. Errors that stand still on a surface and are wider than
// a pixel have none, though the pixels see them elsewhere: what resampling can explain is not counted. Null
// where there is no such pixel.
nlohmann::json flicker(std::span<const float> error, std::span<const float> error_before,
                       std::span<const PastPixels> past);

}  // namespace penumbra::run
