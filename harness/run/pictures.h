// The images of a run: what is asked for, where it lies, and its name in a point's record.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "run/judge.h"

namespace penumbra::run {

// What a picture is held against: the converged reference, or the matched one where there is none.
struct Truth {
  std::span<const float> visibility;
  std::span<const float> standard_error;  // empty: none is known, or the reference is exact
  std::string name;                       // of its folder
};

class Pictures {
 public:
  // `names`: of the config ("visibility", "shaded", ...). Nothing is written when it is empty.
  Pictures(std::filesystem::path run_folder, std::vector<std::string> names);

  // All that the config asks for, as images/<id>/...; pictures that points share (the reference's, and
  // position, normal and triangle of the view) are written once. `view_name` names the
  // view's folder. Returns "images" of the record. Throws WriteError.
  nlohmann::json write(const PointRun& run, const Output& output, std::span<const uint8_t> evaluated,
                       const Truth& truth, const ViewSamplesHost& view, const std::string& view_name) const;
  // Whether the config asks for `name`.
  bool wanted(const char* name) const;
  // Pictures of what the technique shows (output.illustrations) and of the truth's zones, named in `images`;
  // returns "diagnostics" of the record, their legends. Throws WriteError.
  nlohmann::json write_diagnostics(const PointRun& run, const Output& output,
                                   std::span<const uint8_t> evaluated, const Truth& truth,
                                   const ViewSamplesHost& view, nlohmann::json& images) const;

 private:
  std::string visibility(const std::string& folder, const ViewSamplesHost& view,
                         std::span<const float> v) const;
  void shaded(nlohmann::json& images, const char* name, const std::string& folder,
              const ViewSamplesHost& view, const Frame& frame, std::span<const float> v,
              std::span<const float> cosines = {}) const;
  void reference(nlohmann::json& images, const Truth& truth, const ViewSamplesHost& view) const;
  std::string mask(const std::string& folder, const PointRun& run, const Output& output) const;
  void view_pictures(nlohmann::json& images, const std::string& folder, const ViewSamplesHost& view) const;
  std::string make(const std::string& folder, const char* file) const;
  std::filesystem::path root_;
  std::vector<std::string> names_;
};

// Errors of this size and more have the full colour of error.png.
inline constexpr double error_picture_range = 0.25;

}  // namespace penumbra::run
