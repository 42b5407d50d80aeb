// What reading an image file has in common, whatever its format.
#pragma once
#include <cstdint>
#include <filesystem>

namespace penumbra {

// More than any render has, less than what a damaged header may ask memory for: 16384 x 16384.
inline constexpr int64_t max_image_pixels = int64_t{1} << 28;

// Throws InputError when there is no such file, or it is a folder.
void check_image_file(const std::filesystem::path& path);
// Throws InputError when a header claims a size that is not in [1, max_image_pixels].
void check_image_size(const std::filesystem::path& path, int64_t width, int64_t height);

}  // namespace penumbra
