// Images in memory, and OpenEXR and PNG files. Row-major, row 0 on top.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"

namespace penumbra {

struct FloatChannel {
  std::string name;  // "Y", "R", "X", ...
  std::vector<float> values;
};
struct UintChannel {
  std::string name;  // "w0", ...
  std::vector<uint32_t> values;
};
struct ExrImage {
  int width = 0, height = 0;
  std::vector<FloatChannel> floats;
  std::vector<UintChannel> uints;
  const FloatChannel* find(const std::string& name) const;
};

// All channels as 32-bit float or uint (half is widened). Throws InputError (missing, not EXR, truncated).
ExrImage read_exr(const std::filesystem::path& path);
// Written to a temporary beside it and renamed, so never half there. Throws WriteError.
void write_exr(const std::filesystem::path& path, const ExrImage& image);
// Views into caller's memory, without copies: one float channel "Y"; the first three components of an array
// of vectors as three float channels; an array of `names.size()` words per pixel as so many uint channels
// (masks: "w0", "w1", ...).
void write_exr_gray(const std::filesystem::path& path, int width, int height, std::span<const float> values);
void write_exr_vectors(const std::filesystem::path& path, int width, int height,
                       std::span<const Vec3f> values, const std::array<std::string, 3>& names);
void write_exr_vectors(const std::filesystem::path& path, int width, int height,
                       std::span<const Vec4f> values, const std::array<std::string, 3>& names);
void write_exr_words(const std::filesystem::path& path, int width, int height,
                     std::span<const uint32_t> words, const std::vector<std::string>& names);

struct Rgb8Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;  // 3 bytes per pixel, sRGB-encoded
};
// Any PNG as 8-bit RGB: gray and palettes are expanded, 16 bits rounded to 8, transparency laid over black.
// Throws InputError (missing, not PNG, truncated).
Rgb8Image read_png(const std::filesystem::path& path);
// Throws WriteError; as write_exr, never half there.
void write_png(const std::filesystem::path& path, const Rgb8Image& image);

// sRGB transfer function of linear values, clamped to [0, 1], rounded; NaN gives 0.
uint8_t srgb_from_linear(float v);
float linear_from_srgb(uint8_t v);
// As srgb_from_linear; a pixel with a NaN comes out magenta, so that it is seen.
Rgb8Image tonemap(std::span<const Vec3f> linear, int width, int height);

}  // namespace penumbra
