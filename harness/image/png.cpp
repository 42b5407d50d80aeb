// PNG in and out, by libpng's simplified interface: it reports by return value, so no longjmp crosses C++
// frames.
#include <png.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"
#include "image/atomic_file.h"
#include "image/image.h"
#include "image/image_file.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(this); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
};

std::vector<char> read_bytes(const fs::path& path) {
  check_image_file(path);
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = in ? std::streamoff(in.tellg()) : -1;
  if (size < 0) throw InputError(path.string() + ": cannot be read: " + std::strerror(errno) + ".");
  std::vector<char> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  if (!in.read(bytes.data(), size))
    throw InputError(path.string() + ": cannot be read: " + std::strerror(errno) + ".");
  return bytes;
}

}  // namespace

Rgb8Image read_png(const fs::path& path) {
  const std::vector<char> bytes = read_bytes(path);
  PngImage png;
  const auto fail = [&] {
    throw InputError(path.string() + ": cannot be read as a PNG image: " + png.message + ".");
  };
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) fail();
  check_image_size(path, png.width, png.height);
  png.format = PNG_FORMAT_RGB;
  png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // 16-bit files without a colour space are sRGB too
  Rgb8Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.rgb.assign(PNG_IMAGE_SIZE(png), 0);  // the black that transparency is laid over
  const png_color black{0, 0, 0};
  if (!png_image_finish_read(&png, &black, image.rgb.data(), 0, nullptr)) fail();
  return image;
}

void write_png(const fs::path& path, const Rgb8Image& image) {
  const std::size_t bytes =
      3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.width < 1 || image.height < 1 || image.rgb.size() != bytes)
    throw WriteError(path.string() + ": an image of " + std::to_string(image.width) + " x " +
                     std::to_string(image.height) + " pixels and " + std::to_string(image.rgb.size()) +
                     " bytes cannot be written.");
  PngImage png;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<char> encoded(size);
  if (!png_image_write_to_memory(&png, encoded.data(), &size, 0, image.rgb.data(), 0, nullptr))
    throw WriteError(path.string() + ": cannot be written: " + png.message + ".");
  AtomicFile file(path);
  file.write(encoded.data(), size);
  file.commit();
}

}  // namespace penumbra
