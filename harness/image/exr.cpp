// OpenEXR in and out, by the C++ interface of OpenEXR 3.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include "core/error.h"
#include "image/atomic_file.h"
#include "image/image.h"
#include "image/image_file.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

// One channel to be written, wherever its values lie.
struct Source {
  std::string name;
  Imf::PixelType type;
  const void* values;
  std::size_t count;   // values there are
  std::size_t stride;  // bytes from value to value
};

class Stream final : public Imf::OStream {
 public:
  Stream(AtomicFile& file, const std::string& name) : OStream(name.c_str()), file_(file) {}
  void write(const char data[], int bytes) override { file_.write(data, static_cast<std::size_t>(bytes)); }
  uint64_t tellp() override { return file_.position(); }
  void seekp(uint64_t position) override { file_.seek(position); }

 private:
  AtomicFile& file_;
};

void check_sources(const fs::path& path, int width, int height, const std::vector<Source>& sources) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width < 1 || height < 1 || sources.empty())
    throw WriteError(path.string() + ": an image of " + size + " pixels and " +
                     std::to_string(sources.size()) + " channels cannot be written.");
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  for (const Source& s : sources)
    if (s.count != pixels)
      throw WriteError(path.string() + ": channel '" + s.name + "' has " + std::to_string(s.count) +
                       " values, the image " + size + " pixels.");
}

// OpenEXR's slices are not const, though nothing is written through those of an output file.
Imf::Slice slice(const Source& s, int width) {
  char* base = const_cast<char*>(static_cast<const char*>(s.values));
  return Imf::Slice(s.type, base, s.stride, s.stride * static_cast<std::size_t>(width));
}

void write_pixels(AtomicFile& file, const fs::path& path, int width, int height,
                  const std::vector<Source>& sources) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  for (const Source& s : sources) {
    header.channels().insert(s.name, Imf::Channel(s.type));
    frame.insert(s.name, slice(s, width));
  }
  Stream stream(file, path.string());
  Imf::OutputFile out(stream, header);
  out.setFrameBuffer(frame);
  out.writePixels(height);
}

void write_channels(const fs::path& path, int width, int height, const std::vector<Source>& sources) {
  check_sources(path, width, height, sources);
  AtomicFile file(path);
  try {
    write_pixels(file, path, width, height, sources);
  } catch (const std::exception& e) {
    if (file.failed()) file.commit();  // throws with the system's reason, not OpenEXR's wrapping of it
    throw WriteError(path.string() + ": cannot be written: " + e.what() + ".");
  }
  file.commit();
}

template <class V>
void write_vectors(const fs::path& path, int width, int height, std::span<const V> values,
                   const std::vector<std::string>& names) {
  std::vector<Source> sources;
  for (std::size_t i = 0; i < names.size(); ++i)
    sources.push_back(
        {names[i], Imf::FLOAT, reinterpret_cast<const float*>(values.data()) + i, values.size(), sizeof(V)});
  write_channels(path, width, height, sources);
}

// Memory for every channel of the file, and the slices that point at it.
Imf::FrameBuffer allocate(ExrImage& image, const Imf::ChannelList& channels, const Imath::Box2i& window) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  Imf::FrameBuffer frame;
  const auto insert = [&](const char* name, Imf::PixelType type, void* values) {
    frame.insert(name, Imf::Slice::Make(type, values, window, sizeof(float)));
  };
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    if (c.channel().type == Imf::UINT) {
      image.uints.push_back({c.name(), std::vector<uint32_t>(pixels)});
      insert(c.name(), Imf::UINT, image.uints.back().values.data());
    } else {
      image.floats.push_back({c.name(), std::vector<float>(pixels)});
      insert(c.name(), Imf::FLOAT, image.floats.back().values.data());
    }
  }
  return frame;
}

ExrImage read_pixels(const fs::path& path) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1;
  const int64_t height = int64_t{window.max.y} - window.min.y + 1;
  check_image_size(path, width, height);
  if (!file.isComplete())
    throw InputError(path.string() + ": the file is truncated, some of its pixels are missing.");
  const Imf::ChannelList& channels = file.header().channels();
  for (auto c = channels.begin(); c != channels.end(); ++c)
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      throw InputError(path.string() + ": channel '" + c.name() + "' is subsampled, which is not supported.");
  ExrImage image{static_cast<int>(width), static_cast<int>(height), {}, {}};
  file.setFrameBuffer(allocate(image, channels, window));
  file.readPixels(window.min.y, window.max.y);
  return image;
}

}  // namespace

const FloatChannel* ExrImage::find(const std::string& name) const {
  for (const FloatChannel& c : floats)
    if (c.name == name) return &c;
  return nullptr;
}

ExrImage read_exr(const fs::path& path) {
  check_image_file(path);
  try {
    return read_pixels(path);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    throw InputError(path.string() + ": cannot be read as an OpenEXR image: " + e.what());
  }
}

void write_exr(const fs::path& path, const ExrImage& image) {
  std::vector<Source> sources;
  for (const FloatChannel& c : image.floats)
    sources.push_back({c.name, Imf::FLOAT, c.values.data(), c.values.size(), sizeof(float)});
  for (const UintChannel& c : image.uints)
    sources.push_back({c.name, Imf::UINT, c.values.data(), c.values.size(), sizeof(uint32_t)});
  write_channels(path, image.width, image.height, sources);
}

void write_exr_gray(const fs::path& path, int width, int height, std::span<const float> values) {
  write_channels(path, width, height, {{"Y", Imf::FLOAT, values.data(), values.size(), sizeof(float)}});
}

void write_exr_vectors(const fs::path& path, int width, int height, std::span<const Vec3f> values,
                       const std::array<std::string, 3>& names) {
  write_vectors(path, width, height, values, {names.begin(), names.end()});
}

void write_exr_vectors(const fs::path& path, int width, int height, std::span<const Vec4f> values,
                       const std::array<std::string, 3>& names) {
  write_vectors(path, width, height, values, {names.begin(), names.end()});
}

void write_exr_words(const fs::path& path, int width, int height, std::span<const uint32_t> words,
                     const std::vector<std::string>& names) {
  std::vector<Source> sources;
  const std::size_t n = names.size();
  for (std::size_t i = 0; i < n; ++i)
    sources.push_back({names[i], Imf::UINT, words.data() + i, words.size() % n ? 0 : words.size() / n,
                       n * sizeof(uint32_t)});
  write_channels(path, width, height, sources);
}

}  // namespace penumbra
