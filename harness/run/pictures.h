// The images of a run: what is asked for, where it lies, and its name in a point's record.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "run/judge.h"

namespace penumbra::run {

class Pictures {
 public:
  // `names`: of the config ("visibility", "shaded", ...). Nothing is written when it is empty.
  Pictures(std::filesystem::path run_folder, std::vector<std::string> names);

  // All that the config asks for, as images/<id>/...; pictures that points share (the reference's, and
  // position, normal and triangle of the view) are written once. `truth`: the converged reference's
  // visibility, or the matched one's where there is no converged. `truth_name` and `view_name` name their
  // folders. Returns "images" of the record. Throws WriteError.
  nlohmann::json write(const PointRun& run, const Output& output, std::span<const uint8_t> evaluated,
                       std::span<const float> truth, const std::string& truth_name,
                       const ViewSamplesHost& view, const std::string& view_name) const;

 private:
  bool wanted(const char* name) const;
  std::string visibility(const std::string& folder, const ViewSamplesHost& view,
                         std::span<const float> v) const;
  void shaded(nlohmann::json& images, const char* name, const std::string& folder,
              const ViewSamplesHost& view, const Frame& frame, std::span<const float> v,
              std::span<const float> cosines = {}) const;
  std::string mask(const std::string& folder, const PointRun& run, const Output& output) const;
  void view_pictures(nlohmann::json& images, const std::string& folder, const ViewSamplesHost& view) const;
  std::string make(const std::string& folder, const char* file) const;
  std::filesystem::path root_;
  std::vector<std::string> names_;
};

// Errors of this size and more have the full colour of error.png.
inline constexpr double error_picture_range = 0.25;

}  // namespace penumbra::run
