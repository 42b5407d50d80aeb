// Image errors of two files of any origin: what `penumbra metrics REFERENCE TEST` prints.
//
// What is compared, always as linear light:
// - EXR: channels R G B (alpha is ignored) as a colour; else Y as gray; else the one float channel there is
// as gray.
//   A layer's prefix is ignored when just one layer has such channels ("ViewLayer.Combined.R"). The data
//   window is read.
// - PNG: 8-bit sRGB, decoded to linear; a file whose pixels are all gray counts as gray.
// - When both are gray: mae, rmse, max, psnr and ssim on that channel. When either is a colour, gray stands
// for R = G =
//   B; mae, rmse, max, psnr over all three channels of all pixels, ssim on the luminance (Rec. 709).
// - flip: LDR-FLIP at 67 pixels per degree of the colours clamped to [0, 1].
// psnr is for a range of 1, and has no value (null in JSON) when the images are equal.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace penumbra {

struct FileComparison {
  std::string reference, test;  // as given
  int width = 0, height = 0;
  bool color = false;  // compared in three channels
  double mae = 0, rmse = 0, max = 0;
  std::optional<double> psnr;
  double ssim = 0, flip = 0;
};

// Throws InputError, each naming the file or both: missing, neither EXR nor PNG (told by content, not by
// name), damaged, without a picture in it, a value that is not finite, different sizes.
FileComparison compare_files(const std::filesystem::path& reference, const std::filesystem::path& test);

// { "reference", "test", "width", "height", "color", "mae", "rmse", "max", "psnr", "ssim", "flip" },
// indented, one trailing newline. Never NaN or Infinity.
std::string to_json(const FileComparison& comparison);

}  // namespace penumbra
