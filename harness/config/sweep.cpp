#include "config/sweep.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra {
namespace {

template <class Reader>
auto read_list(const JsonNode& node, Reader read) {
  std::vector<decltype(read(node))> values;
  for (const JsonNode& n : node.list_or_one()) values.push_back(read(n));
  if (values.empty()) node.fail("at least one value");
  return values;
}

template <class T, class Reader>
void read_axis(const JsonNode& root, const char* key, std::vector<T>& values, Reader read) {
  const auto node = root.find(key);
  if (!node) return;
  const std::vector<T> more = read_list(*node, read);
  values.insert(values.end(), more.begin(), more.end());
}

// One side: the axis is a number k, or [w, h].
Extent read_extent(const JsonNode& node, int limit) {
  if (!node.is_array()) {
    if (!node.is_number()) node.fail(fmt::format("an integer from 1 to {}, or [width, height]", limit));
    const int side = static_cast<int>(node.integer(1, limit));
    return {side, side};
  }
  if (node.json().size() != 2)
    node.fail("[width, height] (a list of values needs a list around it: [[16, 8]])");
  const std::vector<JsonNode> sides = node.items();
  return {static_cast<int>(sides[0].integer(1, limit)), static_cast<int>(sides[1].integer(1, limit))};
}

NamedValue read_name(const JsonNode& node) {
  if (!node.is_string() || node.string().empty()) node.fail("a name");
  return {node.string(), node};
}

const ParamInfo* find_param(const TechniqueInfo& info, const std::string& name) {
  for (const ParamInfo& p : info.params)
    if (p.name == name) return &p;
  return nullptr;
}

SweepEntry read_entry(const JsonNode& node, const Registry& registry) {
  std::vector<std::string> names;
  for (const TechniqueInfo& info : registry) names.push_back(info.name);
  if (!node.is_object() && !node.is_string())
    node.fail("a technique's name, or {\"technique\": name, \"params\": {...}}");
  if (node.is_object())
    node.allow_only({"technique", "params", "scene", "light", "camera", "title", "caption"},
                    "an entry of techniques");
  const JsonNode name = node.is_object() ? node.require("technique", "an entry of techniques") : node;
  SweepEntry entry;
  entry.info = &find_technique(registry, name.choice(names, "a technique"));
  if (!node.is_object()) return entry;
  read_axis(node, "scene", entry.scenes, read_name);
  read_axis(node, "light", entry.lights, read_name);
  read_axis(node, "camera", entry.cameras, read_name);
  if (const auto title = node.find("title")) entry.title = title->string();
  if (const auto caption = node.find("caption")) entry.caption = caption->string();
  const auto params = node.find("params");
  if (!params) return entry;
  std::vector<std::string> known;
  for (const ParamInfo& p : entry.info->params) known.push_back(p.name);
  params->allow_only(known, "the parameters of " + entry.info->name);
  for (const auto& [key, value] : params->members()) {
    const ParamInfo& info = *find_param(*entry.info, key);
    entry.params[key] = read_list(value, [&](const JsonNode& n) { return read_param(n, info); });
  }
  return entry;
}

// A top-level axis such as grid_size: its values must suit every technique of the config that has it.
void read_param_axis(const JsonNode& root, const std::string& axis, Sweep& sweep) {
  const auto node = root.find(axis);
  if (!node) return;
  auto& values = sweep.axes[axis];
  for (const SweepEntry& entry : sweep.entries) {
    const ParamInfo* info = find_param(*entry.info, axis);
    if (info != nullptr && !entry.params.contains(axis))
      values = read_list(*node, [&](const JsonNode& n) { return read_param(n, *info); });
  }
  if (values.empty())
    values = read_list(*node, [&](const JsonNode& n) { return ParamValue(n.integer(1, limits::grid_size)); });
}

void read_measure(const JsonNode& node, MeasureSettings& measure) {
  node.allow_only({"warmup", "repetitions", "min_time_s", "max_time_s", "target_interval", "counters"},
                  "measure");
  if (const auto n = node.find("warmup")) measure.warmup = static_cast<int>(n->integer(0, 1000));
  if (const auto n = node.find("repetitions")) measure.repetitions = static_cast<int>(n->integer(1, 100000));
  if (const auto n = node.find("min_time_s")) measure.min_time_s = n->number(0, 86400);
  if (const auto n = node.find("max_time_s")) measure.max_time_s = n->number(0.001, 86400);
  if (const auto n = node.find("target_interval")) measure.target_interval = n->number(0, 1);
  if (const auto n = node.find("counters")) measure.counters = n->boolean();
  if (measure.max_time_s < measure.min_time_s)
    node.complain(fmt::format("found max_time_s {} below min_time_s {}, expected it above.",
                              measure.max_time_s, measure.min_time_s));
}

void read_reference(const JsonNode& node, Sweep& sweep) {
  node.allow_only({"light_samples"}, "reference");
  if (const auto n = node.find("light_samples"))
    sweep.reference_samples = static_cast<int>(n->integer(0, limits::reference_samples));
}

std::vector<std::string> read_images(const JsonNode& node) {
  std::vector<std::string> images;
  for (const JsonNode& n : node.items()) {
    const std::string name = n.choice(image_names(), "an image");
    if (std::ranges::find(images, name) == images.end()) images.push_back(name);
  }
  return images;
}

// The run's folder is named by it.
std::string read_run_name(const JsonNode& node) {
  const std::string name = node.string();
  constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  if (name.empty() || name.size() > 100 || name[0] == '.' ||
      name.find_first_not_of(allowed) != std::string::npos)
    node.fail("a name of at most 100 letters, digits, '_', '-' and '.'");
  return name;
}

std::vector<std::string> known_keys(const Registry& registry) {
  std::vector<std::string> keys = {"$schema",   "name",          "description",    "scene",      "resolution",
                                   "mask_size", "light_samples", "light",          "light_size", "techniques",
                                   "reference", "images",        "light_pattern",  "camera",     "measure",
                                   "frames",    "seed",          "light_rotation", "accumulate"};
  for (const std::string& axis : param_axis_names(registry)) keys.push_back(axis);
  return keys;
}

}  // namespace

const std::vector<std::string>& image_names() {
  static const std::vector<std::string> names{"visibility", "shaded", "error",    "mask",
                                              "position",   "normal", "triangle", "diagnostics"};
  return names;
}

const std::vector<std::string>& light_pattern_names() {
  static const std::vector<std::string> names{"regular", "jittered",
                                              "halton"};  // in the order of LightPattern
  return names;
}

const std::vector<std::string>& light_rotation_names() {
  static const std::vector<std::string> names{"none", "per_pixel"};  // in the order of LightRotation
  return names;
}

std::vector<std::string> param_axis_names(const Registry& registry) {
  std::vector<std::string> names{"grid_size"};
  for (const TechniqueInfo& info : registry)
    for (const ParamInfo& p : info.params)
      if (p.axis && std::ranges::find(names, p.name) == names.end()) names.push_back(p.name);
  return names;
}

Extent read_resolution(const JsonNode& node) {
  const Extent e = read_extent(node, limits::resolution);
  if (int64_t{e.width} * e.height > limits::pixels)
    node.complain(fmt::format("found {} x {} pixels, expected at most {} pixels in all.", e.width, e.height,
                              limits::pixels));
  return e;
}

SampleCount read_mask_size(const JsonNode& node) {
  const Extent e = read_extent(node, limits::mask_side);
  return {e.width, e.height, 0};
}

SampleCount read_light_samples(const JsonNode& node) {
  return {1, 1, static_cast<int>(node.integer(1, limits::light_samples))};
}

LightPattern read_light_pattern(const JsonNode& node) {
  const std::vector<std::string>& names = light_pattern_names();
  return static_cast<LightPattern>(std::ranges::find(names, node.choice(names, "a light pattern")) -
                                   names.begin());
}

static LightRotation read_light_rotation(const JsonNode& node) {
  const std::vector<std::string>& names = light_rotation_names();
  return static_cast<LightRotation>(
      std::ranges::find(names, node.choice(names, "a rotation of the light samples")) - names.begin());
}

double read_light_size(const JsonNode& node) { return node.number(0, limits::light_size); }

ParamValue read_param(const JsonNode& node, const ParamInfo& info) {
  const nlohmann::json& j = node.json();
  const bool huge = j.is_number_unsigned() && j.get<uint64_t>() > uint64_t{INT64_MAX};
  ParamValue value;
  if (j.is_boolean())
    value = j.get<bool>();
  else if (j.is_number_integer() && !huge)
    value = j.get<int64_t>();
  else if (j.is_number())
    value = j.get<double>();
  else if (j.is_string())
    value = j.get<std::string>();
  else
    node.fail(fmt::format("{} for the parameter '{}'", expectation(info), info.name));
  try {
    return checked(info, value);
  } catch (const InputError&) {
    std::string near = j.is_string() ? nearest_name(j.get<std::string>(), info.choices) : "";
    if (!near.empty()) near = fmt::format(" Did you mean '{}'?", near);
    node.fail(fmt::format("{} for the parameter '{}'", expectation(info), info.name), near);
  }
}

Sweep parse_sweep(const JsonDocument& document, const Registry& registry, const std::string& fallback_name) {
  const JsonNode root = document.root();
  root.allow_only(known_keys(registry), "a sweep config");
  Sweep sweep;
  sweep.name = fallback_name;
  if (const auto n = root.find("$schema")) (void)n->string();
  if (const auto n = root.find("description")) (void)n->string();
  if (const auto n = root.find("name")) sweep.name = read_run_name(*n);
  (void)root.require("scene", "a sweep config");
  read_axis(root, "scene", sweep.scenes, read_name);
  read_axis(root, "light", sweep.lights, read_name);
  read_axis(root, "camera", sweep.cameras, read_name);
  read_axis(root, "resolution", sweep.resolutions, read_resolution);
  read_axis(root, "mask_size", sweep.samples, read_mask_size);
  read_axis(root, "light_samples", sweep.samples, read_light_samples);
  read_axis(root, "light_pattern", sweep.patterns, read_light_pattern);
  read_axis(root, "light_rotation", sweep.rotations, read_light_rotation);
  read_axis(root, "accumulate", sweep.accumulations,
            [](const JsonNode& n) { return static_cast<int>(n.integer(1, limits::accumulate)); });
  read_axis(root, "light_size", sweep.light_sizes, read_light_size);
  const JsonNode techniques = root.require("techniques", "a sweep config");
  sweep.entries = read_list(techniques, [&](const JsonNode& n) { return read_entry(n, registry); });
  for (const std::string& axis : param_axis_names(registry)) read_param_axis(root, axis, sweep);
  if (const auto n = root.find("reference")) read_reference(*n, sweep);
  if (const auto n = root.find("images")) sweep.images = read_images(*n);
  if (const auto n = root.find("measure")) read_measure(*n, sweep.measure);
  if (const auto n = root.find("frames")) sweep.frames = static_cast<int>(n->integer(1, limits::frames));
  if (const auto n = root.find("seed")) sweep.seed = static_cast<uint32_t>(n->integer(0, UINT32_MAX));
  return sweep;
}

}  // namespace penumbra
