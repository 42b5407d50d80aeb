#include "report/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace penumbra {
namespace fs = std::filesystem;
namespace {

enum class Kind { copy, visibility, shaded, error };

// One picture file to make. Several points share one where they name the same source, as they do for
// references.
struct Job {
  Kind kind = Kind::copy;
  fs::path source, reference;  // relative to the run; `reference` for Kind::error only
  std::string failure;
};

const FloatChannel& only_channel(const ExrImage& image) {
  if (const FloatChannel* y = image.find("Y")) return *y;
  if (image.floats.empty()) throw InputError("has no float channel, expected \"Y\"");
  return image.floats.front();
}

Rgb8Image grey_picture(int width, int height, const std::vector<uint8_t>& grey) {
  Rgb8Image picture{width, height, std::vector<uint8_t>(grey.size() * 3)};
  for (std::size_t i = 0; i < grey.size(); ++i) std::fill_n(&picture.rgb[3 * i], 3, grey[i]);
  return picture;
}

Rgb8Image shaded_picture(const ExrImage& shaded) {
  const FloatChannel *r = shaded.find("R"), *g = shaded.find("G"), *b = shaded.find("B");
  if (!r || !g || !b) r = g = b = &only_channel(shaded);
  std::vector<Vec3f> linear(r->values.size());
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = {r->values[i], g->values[i], b->values[i]};
  return tonemap(linear, shaded.width, shaded.height);
}

// The path inside the run, or an InputError: results may come from someone else, and must not make the report
// pick up files from outside the run.
fs::path inside_run(const std::string& name) {
  const fs::path path = fs::path(name).lexically_normal();
  if (path.empty() || path.is_absolute() || *path.begin() == "..")
    throw InputError(fmt::format("'{}' does not lie inside the run", name));
  return path;
}

bool up_to_date(const fs::path& target, std::initializer_list<fs::path> sources) {
  std::error_code e;
  const auto made = fs::last_write_time(target, e);
  if (e) return false;
  return std::all_of(sources.begin(), sources.end(), [&](const fs::path& source) {
    const auto written = fs::last_write_time(source, e);
    return !e && written <= made;
  });
}

void link_or_copy(const fs::path& source, const fs::path& target) {
  std::error_code e;
  fs::remove(target, e);
  fs::create_hard_link(source, target, e);
  if (!e) return;
  fs::copy_file(source, target, fs::copy_options::overwrite_existing, e);
  if (e) throw WriteError(fmt::format("{}: cannot be written: {}", target.string(), e.message()));
}

void make_picture(const Job& job, const fs::path& run, const fs::path& target, Reuse reuse) {
  const fs::path source = run / job.source;
  const fs::path reference = job.reference.empty() ? source : run / job.reference;
  for (const fs::path& file : {source, reference})
    if (!fs::is_regular_file(file)) throw InputError(fmt::format("{}: no such file", file.string()));
  if (reuse == Reuse::up_to_date && up_to_date(target, {source, reference})) return;
  switch (job.kind) {
    case Kind::copy:
      link_or_copy(source, target);
      break;
    case Kind::visibility:
      write_png(target, visibility_picture(read_exr(source)));
      break;
    case Kind::shaded:
      write_png(target, shaded_picture(read_exr(source)));
      break;
    case Kind::error:
      write_png(target, error_picture(read_exr(reference), read_exr(source)));
      break;
  }
}

bool is_exr(const fs::path& path) { return path.extension() == ".exr"; }

// What the results say about one point's images, turned into jobs by target path.
class Planner {
 public:
  Planner(const fs::path& run, std::map<std::string, Job>& jobs) : run_(run), jobs_(jobs) {}

  nlohmann::json plan(const nlohmann::json& point) {
    nlohmann::json pictures = nlohmann::json::object();
    const auto images = point.find("images");
    if (images == point.end() || !images->is_object()) return pictures;
    const auto add = [&](const char* name, Kind exr_kind) {
      const auto image = images->find(name);
      if (image != images->end() && image->is_string())
        pictures[name] = target_of(inside_run(image->get<std::string>()), exr_kind);
    };
    add("visibility", Kind::visibility);
    add("reference", Kind::visibility);
    add("shaded", Kind::shaded);
    add("reference_shaded", Kind::shaded);
    for (const auto& [name, file] : images->items())
      if (name.starts_with("diagnostic_") && file.is_string() && file.get<std::string>().ends_with(".png"))
        add(name.c_str(), Kind::shaded);
    add_error(*images, pictures);
    return pictures;
  }

 private:
  std::string target_of(fs::path source, Kind exr_kind) {
    // The run writes a ready PNG beside the EXR of a shaded picture.
    if (is_exr(source) && exr_kind == Kind::shaded) {
      fs::path png = fs::path(source).replace_extension(".png");
      if (fs::is_regular_file(run_ / png)) source = png;
    }
    fs::path target =
        fs::path("images") / (*source.begin() == "images" ? source.lexically_relative("images") : source);
    target.replace_extension(".png");
    jobs_.try_emplace(target.generic_string(), Job{is_exr(source) ? exr_kind : Kind::copy, source, {}, {}});
    return target.generic_string();
  }

  // Made anew from the two EXR images, because then its scale is known; the run's own picture is the
  // fall-back.
  void add_error(const nlohmann::json& images, nlohmann::json& pictures) {
    const auto path_of = [&](const char* name) -> fs::path {
      const auto image = images.find(name);
      return image != images.end() && image->is_string() ? inside_run(image->get<std::string>()) : fs::path();
    };
    const fs::path test = path_of("visibility"), reference = path_of("reference");
    if (is_exr(test) && is_exr(reference)) {
      fs::path target =
          fs::path("images") / (*test.begin() == "images" ? test.lexically_relative("images") : test);
      target.replace_filename(target.stem().string() + "_error.png");
      jobs_.try_emplace(target.generic_string(), Job{Kind::error, test, reference, {}});
      pictures["error_code"] = target.generic_string();
    } else if (const fs::path error = path_of("error"); !error.empty()) {
      pictures["error"] = target_of(error, Kind::shaded);
    }
  }

  const fs::path& run_;
  std::map<std::string, Job>& jobs_;
};

void run_jobs(std::map<std::string, Job>& jobs, const fs::path& run, const fs::path& out, Reuse reuse) {
  std::vector<std::pair<const std::string, Job>*> list;
  for (auto& job : jobs) {
    list.push_back(&job);
    fs::create_directories((out / job.first).parent_path());
  }
  std::exception_ptr write_failure;
  std::mutex mutex;
  parallel_for(list.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      try {
        make_picture(list[i]->second, run, out / list[i]->first, reuse);
      } catch (const InputError& e) {
        list[i]->second.failure = e.what();
      } catch (...) {
        const std::lock_guard lock(mutex);
        write_failure = std::current_exception();
      }
    }
  });
  if (write_failure) std::rethrow_exception(write_failure);
}

}  // namespace

uint8_t encode_signed_error(float error) {
  const float e = std::clamp(error, -1.f, 1.f);
  return static_cast<uint8_t>(std::lround(128.f + std::copysign(127.f * std::sqrt(std::abs(e)), e)));
}

float decode_signed_error(uint8_t code) {
  const float root = (static_cast<float>(code) - 128.f) / 127.f;
  return std::copysign(std::min(root * root, 1.f), root);
}

Rgb8Image visibility_picture(const ExrImage& visibility) {
  const FloatChannel& v = only_channel(visibility);
  std::vector<uint8_t> grey(v.values.size());
  std::transform(v.values.begin(), v.values.end(), grey.begin(), [](float x) {
    return static_cast<uint8_t>(std::lround(255.f * (x > 0.f ? std::min(x, 1.f) : 0.f)));
  });
  return grey_picture(visibility.width, visibility.height, grey);
}

Rgb8Image error_picture(const ExrImage& reference, const ExrImage& test) {
  if (reference.width != test.width || reference.height != test.height)
    throw InputError(fmt::format("an image of {} x {} has a reference of {} x {}", test.width, test.height,
                                 reference.width, reference.height));
  const FloatChannel &r = only_channel(reference), &t = only_channel(test);
  std::vector<uint8_t> code(t.values.size());
  for (std::size_t i = 0; i < code.size(); ++i) code[i] = encode_signed_error(t.values[i] - r.values[i]);
  return grey_picture(test.width, test.height, code);
}

nlohmann::json write_pictures(const fs::path& run, const fs::path& out, const nlohmann::json& points,
                              std::size_t& files, std::vector<std::string>& warnings, Reuse reuse) {
  std::map<std::string, Job> jobs;
  Planner planner(run, jobs);
  nlohmann::json by_point = nlohmann::json::array();
  for (const nlohmann::json& point : points) {
    try {
      by_point.push_back(planner.plan(point));
    } catch (const InputError& e) {
      warnings.push_back(e.what());
      by_point.push_back(nlohmann::json::object());
    }
  }
  run_jobs(jobs, run, out, reuse);
  files = 0;
  for (const auto& [target, job] : jobs) {
    if (job.failure.empty())
      ++files;
    else
      warnings.push_back(job.failure);
  }
  for (nlohmann::json& pictures : by_point)
    for (auto it = pictures.begin(); it != pictures.end();)
      it = jobs.at(it->get<std::string>()).failure.empty() ? std::next(it) : pictures.erase(it);
  return by_point;
}

nlohmann::json write_differences(const nlohmann::json& images, const fs::path& baseline,
                                 const fs::path& current, const fs::path& out, std::size_t& files,
                                 std::vector<std::string>& warnings) {
  std::map<std::string, Job> jobs;
  nlohmann::json targets = nlohmann::json::array();
  const auto visibility = [](const nlohmann::json& side) {
    return side.contains("visibility") && side["visibility"].is_string()
               ? fs::path(side["visibility"].get<std::string>())
               : fs::path();
  };
  for (const nlohmann::json& both : images) {
    targets.push_back(nullptr);
    const fs::path before = visibility(both.at("baseline")), now = visibility(both.at("current"));
    if (!is_exr(before) || !is_exr(now)) continue;
    try {
      const fs::path target = ("difference" / inside_run(now.string())).replace_extension(".png");
      jobs.try_emplace(target.generic_string(), Job{Kind::error,
                                                    fs::absolute(current / now),
                                                    fs::absolute(baseline / inside_run(before.string())),
                                                    {}});
      targets.back() = target.generic_string();
    } catch (const InputError& e) {
      warnings.push_back(e.what());
    }
  }
  run_jobs(jobs, {}, out, Reuse::nothing);
  for (nlohmann::json& target : targets) {
    if (target.is_null()) continue;
    const Job& job = jobs.at(target.get<std::string>());
    if (job.failure.empty()) {
      ++files;
    } else {
      warnings.push_back(job.failure);
      target = nullptr;
    }
  }
  return targets;
}

}  // namespace penumbra
