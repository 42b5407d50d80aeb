#include "compare/pixels.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/significance.h"
#include "core/error.h"
#include "image/image.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::string image_of(const json& point, const char* name) {
  const auto images = point.find("images");
  if (images == point.end() || !images->is_object()) return "";
  const auto image = images->find(name);
  return image != images->end() && image->is_string() ? image->get<std::string>() : "";
}

ExrImage read(const RunResults& results, const json& point, const char* name) {
  const fs::path path = fs::path(image_of(point, name)).lexically_normal();
  if (path.empty() || path.is_absolute() || *path.begin() == "..")
    throw InputError(fmt::format("{}: '{}' does not lie inside the run.", results.name, path.string()));
  ExrImage image = read_exr(results.folder / path);
  if (image.floats.size() != 1) throw InputError(fmt::format("{}: expected one channel.", path.string()));
  return image;
}

const std::vector<float>& values(const ExrImage& image) { return image.floats.front().values; }

int reference_samples(const RunResults& results) {
  const json::json_pointer at("/config/reference/light_samples");
  if (!results.run.contains(at) || !results.run.at(at).is_number_integer()) return 0;
  return results.run.at(at).get<int>();
}

void judge(const PixelCheck& c, double p_farther, double p_nearer, double significance, Finding& f) {
  const PixelTest& t = c.outcome.test;
  const double pixels = std::max<double>(double(t.pixels), 1);
  const double net = (double(t.farther) - double(t.nearer)) / pixels;
  const bool worse = p_farther <= significance && net > c.allowed;
  const bool better = p_nearer <= significance && net < -c.allowed;
  f.verdict = worse ? Verdict::regressed : better ? Verdict::improved : Verdict::pass;
  f.current = double(t.farther) / pixels;
  f.p = better ? p_nearer : p_farther;
  if (worse || better)
    f.message =
        fmt::format("of {} pixels that changed {} are farther from the truth and {} nearer (p = {:.2g}){}",
                    t.changed, t.farther, t.nearer, *f.p, worse ? "; " + c.outcome.worst : "");
}

}  // namespace

bool has_pixels(const RunResults& baseline, const json& before, const RunResults& current, const json& now) {
  const auto has = [](const json& point, const char* name) {
    return image_of(point, name).ends_with(".exr");
  };
  return !baseline.folder.empty() && !current.folder.empty() && has(before, "visibility") &&
         has(before, "reference") && has(now, "visibility") && has(now, "reference") &&
         has(now, "reference_standard_error");
}

PixelOutcome judge_pixels(const RunResults& baseline, const json& before, const RunResults& current,
                          const json& now) {
  PixelOutcome out;
  try {
    const ExrImage old = read(baseline, before, "visibility"), fresh = read(current, now, "visibility");
    const ExrImage truth = read(current, now, "reference");
    if (values(read(baseline, before, "reference")) != values(truth)) {
      out.why_not = "the runs have different references";
      return out;
    }
    const ExrImage error = read(current, now, "reference_standard_error");
    const int samples = reference_samples(current);
    const EstimatedTruth estimate{values(truth), values(error), samples, std::min(samples, 8)};
    out.test = test_pixels(values(old), values(fresh), estimate);
    if (const auto i = out.test.worst)
      out.worst =
          fmt::format("({}, {}): {:.4g} was {:.4g}, the truth is {:.4g} +- {:.2g}",
                      *i % static_cast<std::size_t>(truth.width), *i / static_cast<std::size_t>(truth.width),
                      values(fresh)[*i], values(old)[*i], values(truth)[*i], values(error)[*i]);
  } catch (const InputError& e) {
    out.why_not = e.what();
  }
  return out;
}

void judge_pixel_checks(const std::vector<PixelCheck>& checks, double significance,
                        std::vector<Finding>& findings) {
  std::vector<double> farther, nearer;
  for (const PixelCheck& c : checks)
    farther.push_back(c.outcome.test.p_farther), nearer.push_back(c.outcome.test.p_nearer);
  farther = holm(farther), nearer = holm(nearer);
  for (std::size_t i = 0; i < checks.size(); ++i)
    judge(checks[i], farther[i], nearer[i], significance, findings[checks[i].finding]);
}

}  // namespace penumbra::compare
