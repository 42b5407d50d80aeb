// From a sweep config to the list of points that it means. Pure functions: no device, no files but the config
// itself.
#pragma once
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "samples/light_samples.h"
#include "technique/technique.h"

namespace penumbra {

struct MeasureSettings {
  int warmup = 1, repetitions = 7;
  double min_time_s = 0.2, max_time_s = 60;
  // Go on until the median's 95 % interval reaches no further than this share of the median to either side,
  // or max_time_s is over; 0: no such target.
  double target_interval = 0;
  // Statistics of the technique's own: never in the times, but some cost more than the frame.
  bool counters = true;
};

// Everything that determines one result.
struct Point {
  std::string id;  // 16 hex digits of the hash of all that follows
  std::string technique;
  ParamValues params;         // resolved: every parameter of the technique, grid_size included if it has it
  std::string scene;          // name or path as given
  std::string light, camera;  // resolved names
  int width = 512, height = 512;
  LightSampleRequest light_samples;  // count 1 x 1 for techniques that are not sampled
  bool sampled = false;
  int accumulate = 1;      // frames, each with another set of light samples, whose mean is the result
  double light_size = -1;  // < 0: the scene's own
  int frame = 0;
  uint32_t seed = 1;
  // Not part of the id:
  std::string title, caption;  // the config entry's, for the report's gallery
  std::string invocation;      // "penumbra run CONFIG --set ...", shell-quoted

  std::string key() const;      // technique/scene/key=value,... as --filter sees it; unique in a plan
  std::string command() const;  // the exact command line that runs this point alone
};

struct Plan {
  std::string name;
  std::vector<Point> points;    // grouped: points that share scene, camera, resolution and frame are adjacent
  std::vector<Point> left_out;  // those that the filter does not match
  int reference_samples = 4096;     // 0: no converged reference
  std::vector<std::string> images;  // visibility, shaded, error, mask, position, normal, triangle
  MeasureSettings measure;
  int frames = 1;
  uint32_t seed = 1;
  std::string expanded_config;  // JSON text of the resolved config, for run.json
};

struct PlanOptions {
  std::vector<std::string> set;  // --set /pointer=json
  std::string filter;            // --filter REGEX
};

// Throws InputError: file, line:column, JSON pointer, what was found, what was expected, the nearest valid
// name. `scene_search`: folders in which scene names are looked up.
Plan load_plan(const std::filesystem::path& config, const PlanOptions& options, const Registry& registry,
               const std::vector<std::filesystem::path>& scene_search);

// 16 for a square, [w, h] otherwise.
nlohmann::json extent_to_json(int width, int height);
nlohmann::json param_to_json(const ParamValue& value);

}  // namespace penumbra
