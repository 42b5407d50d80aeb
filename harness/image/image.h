// Images in memory, and OpenEXR and PNG files. Row-major, row 0 on top.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"

namespace penumbra {

struct FloatChannel {
  std::string name;                 // "Y", "R", "X", ...
  std::vector<float> values;
};
struct UintChannel {
  std::string name;                 // "w0", ...
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
// Views into caller's memory, without copies: one float channel "Y"; `channels` of an interleaved Vec3 or Vec4 array.
void write_exr_gray(const std::filesystem::path& path, int width, int height, std::span<const float> values);

struct Rgb8Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;         // 3 bytes per pixel, sRGB-encoded
};
Rgb8Image read_png(const std::filesystem::path& path);
void write_png(const std::filesystem::path& path, const Rgb8Image& image);

// sRGB transfer function of linear values, clamped to [0, 1], rounded.
uint8_t srgb_from_linear(float v);
float linear_from_srgb(uint8_t v);
Rgb8Image tonemap(std::span<const Vec3f> linear, int width, int height);

}  // namespace penumbra
