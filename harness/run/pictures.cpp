#include "run/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "image/image.h"
#include "metrics/error_map.h"
#include "run/diagnostics.h"
#include "run/files.h"

namespace penumbra::run {
namespace {

// Components of an array of vectors as named channels.
void add_vector_channels(ExrImage& image, std::span<const Vec4f> values) {
  for (const int c : {0, 1, 2}) {
    FloatChannel channel{std::string(1, "XYZ"[c]), std::vector<float>(values.size())};
    std::ranges::transform(values, channel.values.begin(), [c](const Vec4f& v) { return v[c]; });
    image.floats.push_back(std::move(channel));
  }
}

ExrImage color_image(const std::vector<Vec3f>& linear, int width, int height) {
  ExrImage image{width, height, {}, {}};
  for (const int c : {0, 1, 2}) {
    FloatChannel channel{std::string(1, "RGB"[c]), std::vector<float>(linear.size())};
    std::ranges::transform(linear, channel.values.begin(), [c](const Vec3f& v) { return v[c]; });
    image.floats.push_back(std::move(channel));
  }
  return image;
}

}  // namespace

Pictures::Pictures(std::filesystem::path run_folder, std::vector<std::string> names)
    : root_(std::move(run_folder)), names_(std::move(names)) {}

bool Pictures::wanted(const char* name) const { return std::ranges::find(names_, name) != names_.end(); }

std::string Pictures::make(const std::string& folder, const char* file) const {
  make_folder(root_ / folder);
  return folder + "/" + file;
}

std::string Pictures::visibility(const std::string& folder, const ViewSamplesHost& view,
                                 std::span<const float> v) const {
  const std::string path = make(folder, "visibility.exr");
  write_exr_gray(root_ / path, view.width, view.height, v);
  return path;
}

void Pictures::shaded(nlohmann::json& images, const char* name, const std::string& folder,
                      const ViewSamplesHost& view, const Frame& frame, std::span<const float> v,
                      std::span<const float> cosines) const {
  const auto linear = shade(view, frame, v, cosines);
  const std::string exr = make(folder, "shaded.exr"), png = make(folder, "shaded.png");
  write_exr(root_ / exr, color_image(linear, view.width, view.height));
  write_png(root_ / png, tonemap(linear, view.width, view.height));
  images[name] = png;
  images[std::string(name) + "_exr"] = exr;
}

std::string Pictures::mask(const std::string& folder, const PointRun& run, const Output& output) const {
  ExrImage image{run.point().width, run.point().height, {}, {}};
  const std::size_t pixels = output.visibility.size(), words = output.mask.size() / pixels;
  for (std::size_t w = 0; w < words; ++w) {
    UintChannel channel{fmt::format("w{}", w), std::vector<uint32_t>(pixels)};
    for (std::size_t i = 0; i < pixels; ++i) channel.values[i] = output.mask[i * words + w];
    image.uints.push_back(std::move(channel));
  }
  const std::string path = make(folder, "mask.exr");
  write_exr(root_ / path, image);
  return path;
}

void Pictures::view_pictures(nlohmann::json& images, const std::string& folder,
                             const ViewSamplesHost& view) const {
  const auto write_once = [&](const char* name, const char* file, auto&& fill) {
    if (!wanted(name)) return;
    const std::string path = make(folder, file);
    images[name] = path;
    if (std::filesystem::exists(root_ / path)) return;
    ExrImage image{view.width, view.height, {}, {}};
    fill(image);
    write_exr(root_ / path, image);
  };
  write_once("position", "position.exr", [&](ExrImage& image) { add_vector_channels(image, view.position); });
  write_once("normal", "normal.exr",
             [&](ExrImage& image) { add_vector_channels(image, view.geometric_normal); });
  write_once("triangle", "triangle.exr", [&](ExrImage& image) {
    image.uints.push_back({"Y", std::vector<uint32_t>(view.triangle.begin(), view.triangle.end())});
  });
}

void Pictures::reference(nlohmann::json& images, const Truth& truth, const ViewSamplesHost& view) const {
  const std::string folder = "images/reference-" + truth.name;
  const auto write_once = [&](const char* name, const char* file, std::span<const float> values) {
    const std::string path = make(folder, file);
    images[name] = path;
    if (!std::filesystem::exists(root_ / path)) write_exr_gray(root_ / path, view.width, view.height, values);
  };
  write_once("reference", "visibility.exr", truth.visibility);
  if (!truth.standard_error.empty())
    write_once("reference_standard_error", "standard_error.exr", truth.standard_error);
}

nlohmann::json Pictures::write_diagnostics(const PointRun& run, const Output& output,
                                           std::span<const uint8_t> evaluated, const Truth& truth,
                                           const ViewSamplesHost& view, nlohmann::json& images) const {
  nlohmann::json legends = nlohmann::json::array();
  const Frame& frame = run.lit().current;
  const Backdrop back = backdrop(shade(view, frame, output.visibility, output.cosines), view, frame.camera);
  const auto add = [&](const Illustration& illustration) {
    const Drawn drawn = draw(illustration, back);
    const std::string folder = "images/" + run.point().id, name = "diagnostic_" + illustration.name;
    images[name] = make(folder, (name + ".png").c_str());
    write_png(root_ / images[name].get<std::string>(), drawn.picture);
    if (!drawn.figures.empty()) {
      images[name + "_exr"] = make(folder, (name + ".exr").c_str());
      write_exr_gray(root_ / images[name + "_exr"].get<std::string>(), drawn.width, drawn.height,
                     drawn.figures);
    }
    legends.push_back(drawn.legend);
  };
  for (const Illustration& illustration : output.illustrations) add(illustration);
  add(zones(truth.visibility, evaluated));
  return legends;
}

nlohmann::json Pictures::write(const PointRun& run, const Output& output, std::span<const uint8_t> evaluated,
                               const Truth& truth, const ViewSamplesHost& view,
                               const std::string& view_name) const {
  nlohmann::json images = nlohmann::json::object();
  if (names_.empty()) return images;
  const std::string folder = "images/" + run.point().id, truth_folder = "images/reference-" + truth.name;
  const Frame& frame = run.lit().current;
  if (wanted("visibility")) {
    images["visibility"] = visibility(folder, view, output.visibility);
    reference(images, truth, view);
  }
  if (wanted("shaded")) {
    shaded(images, "shaded", folder, view, frame, output.visibility, output.cosines);
    // Whoever comes first writes the reference's; each point names both files.
    if (std::filesystem::exists(root_ / truth_folder / "shaded.png")) {
      images["reference_shaded"] = truth_folder + "/shaded.png";
      images["reference_shaded_exr"] = truth_folder + "/shaded.exr";
    } else {
      shaded(images, "reference_shaded", truth_folder, view, frame, truth.visibility);
    }
  }
  if (wanted("error")) {
    images["error"] = make(folder, "error.png");
    write_png(root_ / images["error"].get<std::string>(),
              error_map({view.width, view.height, truth.visibility, evaluated},
                        {view.width, view.height, output.visibility, evaluated}, error_picture_range));
  }
  if (wanted("mask") && !output.mask.empty()) images["mask"] = mask(folder, run, output);
  view_pictures(images, "images/view-" + view_name, view);
  return images;
}

}  // namespace penumbra::run
