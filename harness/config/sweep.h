// A sweep config as parsed and checked, not yet expanded.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/plan.h"
#include "core/json_text.h"

namespace penumbra {

struct Extent {
  int width = 1, height = 1;
};

// mask_size and light_samples are two spellings of one axis: how many light samples.
struct SampleCount {
  int width = 16, height = 16;
  int count = 0;  // light_samples; 0: width x height
};

struct NamedValue {
  std::string name;
  JsonNode node;  // where it stands, for messages
};

// Values of parameters: each list is an axis.
using ParamAxes = std::map<std::string, std::vector<ParamValue>>;

struct SweepEntry {
  const TechniqueInfo* info = nullptr;
  ParamAxes params;
  std::vector<NamedValue> scenes, lights, cameras;  // in place of the sweep's; empty: the sweep's
  std::string title, caption;                       // how the report's gallery names and explains it
};

// Axes without values are left to the scene.
struct Sweep {
  std::string name;
  std::vector<NamedValue> scenes, lights, cameras;
  std::vector<Extent> resolutions;
  std::vector<SampleCount> samples;
  std::vector<LightPattern> patterns;
  std::vector<LightRotation> rotations;  // empty: none
  std::vector<int> accumulations;        // empty: 1
  std::vector<double> light_sizes;
  ParamAxes axes;  // grid_size and other parameters that are top-level axes too
  std::vector<SweepEntry> entries;
  int reference_samples = 4096;
  std::vector<std::string> images{"visibility", "shaded", "error"};
  MeasureSettings measure;
  int frames = 1;
  uint32_t seed = 1;
};

// Throws InputError. `fallback_name`: when the config has no "name".
Sweep parse_sweep(const JsonDocument& document, const Registry& registry, const std::string& fallback_name);

// Readers that scene files' axis defaults share. `node` is one value, not a list.
Extent read_resolution(const JsonNode& node);
SampleCount read_mask_size(const JsonNode& node);
SampleCount read_light_samples(const JsonNode& node);
LightPattern read_light_pattern(const JsonNode& node);
double read_light_size(const JsonNode& node);
ParamValue read_param(const JsonNode& node, const ParamInfo& info);

// What the grammar allows, once: the parser and the schema read it from here.
namespace limits {
inline constexpr int resolution = 16384;    // per side
inline constexpr int64_t pixels = 1 << 26;  // view samples take about 160 bytes a pixel: 10 GiB
inline constexpr int mask_side = 256;
inline constexpr int light_samples = 65536;
inline constexpr double light_size = 1e9;
inline constexpr int reference_samples = 1 << 20;
inline constexpr int accumulate = 1024;
inline constexpr int frames = 100000;
inline constexpr int grid_size = 65536;
inline constexpr int64_t points = 1000000;
}  // namespace limits
const std::vector<std::string>& image_names();
const std::vector<std::string>& light_pattern_names();
const std::vector<std::string>& light_rotation_names();
// Names of parameters that are top-level axes too: grid_size, and what the registry marks.
std::vector<std::string> param_axis_names(const Registry& registry);

}  // namespace penumbra
