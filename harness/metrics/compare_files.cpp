#include "metrics/compare_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/error.h"
#include "image/image.h"
#include "image/image_file.h"
#include "metrics/checks.h"
#include "metrics/metrics.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

struct Picture {
  int width = 0, height = 0;
  bool color = false;
  std::vector<Vec3f> rgb;
};

std::string channel_names(const ExrImage& image) {
  std::string names;
  for (const FloatChannel& c : image.floats) names += (names.empty() ? "" : ", ") + c.name;
  for (const UintChannel& c : image.uints) names += (names.empty() ? "" : ", ") + c.name + " (uint)";
  return names.empty() ? "none" : names;
}

// Layers ("" or "name.") that have all the given channels.
std::vector<std::string> layers_with(const ExrImage& image, const std::vector<std::string>& channels) {
  std::set<std::string> prefixes;
  for (const FloatChannel& c : image.floats) prefixes.insert(c.name.substr(0, c.name.rfind('.') + 1));
  std::vector<std::string> layers;
  for (const std::string& p : prefixes)
    if (std::all_of(channels.begin(), channels.end(),
                    [&](const std::string& c) { return image.find(p + c); }))
      layers.push_back(p);
  return layers;
}

// Channels R G B or Y of the plain layer, or else of the only layer that has them; the only float channel at
// last.
std::vector<const FloatChannel*> picture_channels(const ExrImage& image, const fs::path& path) {
  for (const std::vector<std::string>& wanted : {std::vector<std::string>{"R", "G", "B"}, {"Y"}}) {
    const std::vector<std::string> layers = layers_with(image, wanted);
    if (layers.empty() || (layers.size() > 1 && !layers.front().empty())) continue;  // "" sorts first
    std::vector<const FloatChannel*> found;
    for (const std::string& c : wanted) found.push_back(image.find(layers.front() + c));
    return found;
  }
  if (image.floats.size() == 1) return {&image.floats.front()};
  throw InputError(
      path.string() +
      ": no picture to compare: expected channels R, G, B, or Y, or a single float channel; found " +
      channel_names(image) + ".");
}

Picture picture_from_exr(const fs::path& path) {
  const ExrImage image = read_exr(path);
  const std::vector<const FloatChannel*> channels = picture_channels(image, path);
  Picture picture{image.width, image.height, channels.size() == 3, {}};
  for (const FloatChannel* c : channels)
    for (std::size_t i = 0; i < c->values.size(); ++i)
      check_finite((path.string() + ": channel '" + c->name + "'").c_str(), c->values[i], i, image.width);
  picture.rgb.resize(channels[0]->values.size());
  for (std::size_t i = 0; i < picture.rgb.size(); ++i)
    for (int c = 0; c < 3; ++c)
      picture.rgb[i][c] = channels[picture.color ? static_cast<std::size_t>(c) : 0]->values[i];
  return picture;
}

Picture picture_from_png(const fs::path& path) {
  const Rgb8Image image = read_png(path);
  Picture picture{image.width, image.height, false, {}};
  picture.rgb.resize(image.rgb.size() / 3);
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    const uint8_t* p = &image.rgb[3 * i];
    picture.color |= p[0] != p[1] || p[1] != p[2];
    picture.rgb[i] = {linear_from_srgb(p[0]), linear_from_srgb(p[1]), linear_from_srgb(p[2])};
  }
  return picture;
}

Picture read_picture(const fs::path& path) {
  check_image_file(path);
  std::array<char, 4> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  if (head == std::array<char, 4>{'\x89', 'P', 'N', 'G'}) return picture_from_png(path);
  if (head == std::array<char, 4>{'\x76', '\x2f', '\x31', '\x01'}) return picture_from_exr(path);
  throw InputError(path.string() + ": neither an OpenEXR nor a PNG image.");
}

// Channels one below the other as one image, so that errors are over all of them.
std::vector<float> stacked(const Picture& p, int channels) {
  std::vector<float> values;
  values.reserve(p.rgb.size() * static_cast<std::size_t>(channels));
  for (int c = 0; c < channels; ++c)
    for (const Vec3f& v : p.rgb) values.push_back(v[c]);
  return values;
}

std::vector<float> luminance(const Picture& p, bool color) {
  std::vector<float> values;
  values.reserve(p.rgb.size());
  for (const Vec3f& v : p.rgb) values.push_back(color ? 0.2126f * v.x + 0.7152f * v.y + 0.0722f * v.z : v.x);
  return values;
}

}  // namespace

FileComparison compare_files(const fs::path& reference, const fs::path& test) {
  const Picture a = read_picture(reference), b = read_picture(test);
  if (a.width != b.width || a.height != b.height)
    throw InputError("The images differ in size: " + reference.string() + " is " +
                     size_text(a.width, a.height) + ", " + test.string() + " is " +
                     size_text(b.width, b.height) + ".");
  FileComparison r;
  r.reference = reference.string(), r.test = test.string();
  r.width = a.width, r.height = a.height;
  r.color = a.color || b.color;
  const int channels = r.color ? 3 : 1;
  const std::vector<float> all_a = stacked(a, channels), all_b = stacked(b, channels);
  const ImageErrors errors =
      pixel_errors({a.width, a.height * channels, all_a, {}}, {b.width, b.height * channels, all_b, {}});
  r.mae = errors.mae.value(), r.rmse = errors.rmse.value(), r.max = errors.max.value(), r.psnr = errors.psnr;
  const std::vector<float> la = luminance(a, r.color), lb = luminance(b, r.color);
  r.ssim = ssim({a.width, a.height, la, {}}, {b.width, b.height, lb, {}}).value();
  r.flip = flip(a.rgb, b.rgb, a.width, a.height).mean;
  return r;
}

std::string to_json(const FileComparison& c) {
  // nlohmann writes null for what is not finite.
  nlohmann::ordered_json j;
  j["reference"] = c.reference, j["test"] = c.test;
  j["width"] = c.width, j["height"] = c.height, j["color"] = c.color;
  j["mae"] = c.mae, j["rmse"] = c.rmse, j["max"] = c.max;
  j["psnr"] = c.psnr ? nlohmann::ordered_json(*c.psnr) : nlohmann::ordered_json(nullptr);
  j["ssim"] = c.ssim, j["flip"] = c.flip;
  return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace penumbra
