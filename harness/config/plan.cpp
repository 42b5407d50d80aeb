#include "config/plan.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "config/expand.h"
#include "config/sweep.h"
#include "core/hash.h"

namespace penumbra {
namespace {

using nlohmann::json;

std::string extent_text(int width, int height) {
  return width == height ? fmt::format("{}", width) : fmt::format("{}x{}", width, height);
}

// For a POSIX shell; left bare where nothing needs quoting.
std::string shell_quoted(const std::string& text) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string regex_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("\\^$.|?*+()[]{}").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

json params_to_json(const ParamAxes& params) {
  json out = json::object();
  for (const auto& [name, values] : params) {
    out[name] = json::array();
    for (const ParamValue& value : values) out[name].push_back(param_to_json(value));
  }
  return out;
}

json names_to_json(const std::vector<NamedValue>& values) {
  json out = json::array();
  for (const NamedValue& v : values) out.push_back(v.name);
  return out;
}

// The config with every list written out and every default of the grammar filled in; axes that are left to
// the scenes stay away. It is a valid config itself.
json expanded(const Sweep& sweep) {
  json out = {{"name", sweep.name},
              {"scene", names_to_json(sweep.scenes)},
              {"reference", {{"light_samples", sweep.reference_samples}}},
              {"images", sweep.images},
              {"measure",
               {{"warmup", sweep.measure.warmup},
                {"repetitions", sweep.measure.repetitions},
                {"min_time_s", sweep.measure.min_time_s},
                {"max_time_s", sweep.measure.max_time_s},
                {"target_interval", sweep.measure.target_interval},
                {"counters", sweep.measure.counters}}},
              {"frames", sweep.frames},
              {"seed", sweep.seed}};
  if (!sweep.lights.empty()) out["light"] = names_to_json(sweep.lights);
  if (!sweep.cameras.empty()) out["camera"] = names_to_json(sweep.cameras);
  for (const Extent& e : sweep.resolutions) out["resolution"].push_back(extent_to_json(e.width, e.height));
  for (const SampleCount& s : sweep.samples)
    if (s.count > 0)
      out["light_samples"].push_back(s.count);
    else
      out["mask_size"].push_back(extent_to_json(s.width, s.height));
  for (const LightPattern p : sweep.patterns)
    out["light_pattern"].push_back(light_pattern_names()[static_cast<std::size_t>(p)]);
  for (const LightRotation r : sweep.rotations)
    out["light_rotation"].push_back(light_rotation_names()[static_cast<std::size_t>(r)]);
  for (const int n : sweep.accumulations) out["accumulate"].push_back(n);
  for (const double size : sweep.light_sizes) out["light_size"].push_back(size);
  out.update(params_to_json(sweep.axes));
  for (const SweepEntry& entry : sweep.entries) {
    json one = {{"technique", entry.info->name}, {"params", params_to_json(entry.params)}};
    if (!entry.scenes.empty()) one["scene"] = names_to_json(entry.scenes);
    if (!entry.lights.empty()) one["light"] = names_to_json(entry.lights);
    if (!entry.cameras.empty()) one["camera"] = names_to_json(entry.cameras);
    if (!entry.title.empty()) one["title"] = entry.title;
    if (!entry.caption.empty()) one["caption"] = entry.caption;
    out["techniques"].push_back(one);
  }
  return out;
}

std::string invocation(const std::filesystem::path& config, const std::vector<std::string>& set) {
  std::string out = "penumbra run " + shell_quoted(config.string());
  for (const std::string& assignment : set) out += " --set " + shell_quoted(assignment);
  return out;
}

}  // namespace

json extent_to_json(int width, int height) {
  return width == height ? json(width) : json::array({width, height});
}

json param_to_json(const ParamValue& value) {
  return std::visit([](const auto& v) { return json(v); }, value);
}

std::string Point::key() const {
  std::string out = fmt::format("{}/{}/resolution={},camera={},light={}", technique, scene,
                                extent_text(width, height), camera, light);
  if (light_size >= 0) out += fmt::format(",light_size={}", light_size);
  if (sampled) {
    out += light_samples.count > 0
               ? fmt::format(",light_samples={}", light_samples.count)
               : fmt::format(",mask_size={}", extent_text(light_samples.width, light_samples.height));
    out += ",light_pattern=" + light_pattern_names()[static_cast<std::size_t>(light_samples.pattern)];
    if (light_samples.rotation != LightRotation::none)
      out += ",light_rotation=" + light_rotation_names()[static_cast<std::size_t>(light_samples.rotation)];
    if (accumulate > 1) out += fmt::format(",accumulate={}", accumulate);
  }
  for (const auto& [name, value] : params) out += fmt::format(",{}={}", name, to_text(value));
  return out + fmt::format(",frame={}", frame);
}

std::string Point::command() const {
  return invocation + " --filter " + shell_quoted("^" + regex_escaped(key()) + "$");
}

std::string point_id(const Point& point) {
  return Hasher().text("point 1").text(point.key()).value(point.seed).hex().substr(0, 16);
}

Plan load_plan(const std::filesystem::path& config, const PlanOptions& options, const Registry& registry,
               const std::vector<std::filesystem::path>& scene_search) {
  JsonDocument document = JsonDocument::read(config);
  for (const std::string& assignment : options.set) document.set(assignment);
  const Sweep sweep = parse_sweep(document, registry, config.stem().string());
  const DeclareScene declare = [&](const std::string& name) { return declare_scene(name, scene_search); };
  Plan plan;
  plan.name = sweep.name;
  plan.points = filter_points(expand(sweep, declare), options.filter, &plan.left_out);
  for (Point& p : plan.points) p.invocation = invocation(config, options.set);
  plan.reference_samples = sweep.reference_samples;
  plan.images = sweep.images;
  plan.measure = sweep.measure;
  plan.frames = sweep.frames;
  plan.seed = sweep.seed;
  plan.expanded_config = expanded(sweep).dump(2);
  return plan;
}

}  // namespace penumbra
