// The report's pictures: PNGs made from the images that a run has written.
#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"

namespace penumbra {

// Signed error as one byte: 128 is none, and the distance from it is the square root of |e|, so that errors
// of a single light sample among a thousand are still told apart. The page decodes it with whatever range is
// asked for.
uint8_t encode_signed_error(float error);
float decode_signed_error(uint8_t code);

// Visibility as grey, value 255 V (not gamma-encoded: equal steps of V are equal steps of the code).
Rgb8Image visibility_picture(const ExrImage& visibility);
// test - reference, encoded as above, grey. Throws InputError when the sizes differ.
Rgb8Image error_picture(const ExrImage& reference, const ExrImage& test);

// Whether files that are newer than their sources are kept: not where the sources' names may be another
// run's.
enum class Reuse { up_to_date, nothing };

// Writes out/images/... for every point that names images. Returns, in points' order, one object
// { "visibility", "shaded", "error", "reference", "reference_shaded": path relative to `out` } per point,
// each key only where there is such a picture; "error_code" in place of "error" where the error is encoded as
// above.
nlohmann::json write_pictures(const std::filesystem::path& run, const std::filesystem::path& out,
                              const nlohmann::json& points, std::size_t& files,
                              std::vector<std::string>& warnings, Reuse reuse = Reuse::up_to_date);

// What has changed between two runs: for each of `images` ({ "baseline", "current" } of a point, as its
// records name them) out/difference/... with the difference current - baseline of the visibilities, encoded
// as above. Returns their paths, null where either is missing.
nlohmann::json write_differences(const nlohmann::json& images, const std::filesystem::path& baseline,
                                 const std::filesystem::path& current, const std::filesystem::path& out,
                                 std::size_t& files, std::vector<std::string>& warnings);

}  // namespace penumbra
