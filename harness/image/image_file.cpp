#include "image/image_file.h"

#include <string>

#include "core/error.h"

namespace penumbra {

void check_image_file(const std::filesystem::path& path) {
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (status.type() == std::filesystem::file_type::not_found)
    throw InputError(path.string() + ": no such file.");
  if (code) throw InputError(path.string() + ": cannot be read: " + code.message() + ".");
  if (std::filesystem::is_directory(status))
    throw InputError(path.string() + ": is a directory, an image file was expected.");
}

void check_image_size(const std::filesystem::path& path, int64_t width, int64_t height) {
  // Each side by itself first, so that the product cannot overflow.
  const bool sides = width >= 1 && height >= 1 && width <= max_image_pixels && height <= max_image_pixels;
  if (sides && width * height <= max_image_pixels) return;
  throw InputError(path.string() + ": the image is " + std::to_string(width) + " x " +
                   std::to_string(height) + " pixels; expected 1 to " + std::to_string(max_image_pixels) +
                   " pixels in all.");
}

}  // namespace penumbra
