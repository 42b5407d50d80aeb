#include "config/schema.h"

#include <fmt/format.h>

#include "config/sweep.h"
#include "scene/scene_schema.h"

namespace penumbra {
namespace {

using nlohmann::json;

json integer(int64_t lo, int64_t hi) { return {{"type", "integer"}, {"minimum", lo}, {"maximum", hi}}; }
json number(double lo, double hi) { return {{"type", "number"}, {"minimum", lo}, {"maximum", hi}}; }
json choice(const std::vector<std::string>& names) { return {{"type", "string"}, {"enum", names}}; }
json name() { return {{"type", "string"}, {"minLength", 1}}; }

// Every axis takes a value or a list of values.
json axis(const json& value, const std::string& description) {
  return {{"description", description},
          {"anyOf", json::array({value, {{"type", "array"}, {"items", value}, {"minItems", 1}}})}};
}

// k or [w, h]. At the top level a flat array is a list of values, so that a rectangle stands in a list: [[16,
// 8]].
json extent_axis(int limit, const std::string& description) {
  const json side = integer(1, limit);
  const json pair = {{"type", "array"}, {"items", side}, {"minItems", 2}, {"maxItems", 2}};
  const json element = {{"anyOf", json::array({side, pair})}};
  return {{"description", description + " n, or a list whose elements are n or [width, height]."},
          {"anyOf", json::array({side, {{"type", "array"}, {"items", element}, {"minItems", 1}}})}};
}

json object(const json& properties, const std::vector<std::string>& required = {}) {
  json out = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) out["required"] = required;
  return out;
}

json param_value(const ParamInfo& info) {
  switch (info.type) {
    case ParamType::boolean:
      return {{"type", "boolean"}};
    case ParamType::integer:
      return integer(static_cast<int64_t>(info.lo), static_cast<int64_t>(info.hi));
    case ParamType::number:
      return number(info.lo, info.hi);
    case ParamType::choice:
      return choice(info.choices);
  }
  return {};
}

json param_axis(const ParamInfo& info) {
  std::string text = info.help;
  if (!info.unit.empty()) text += fmt::format(" Unit: {}.", info.unit);
  if (!info.symbol.empty()) text += fmt::format(" In the source: {}.", info.symbol);
  json out = axis(param_value(info), text);
  out["default"] = param_to_json(info.fallback);
  return out;
}

json technique_entry(const TechniqueInfo& info) {
  json params = json::object();
  for (const ParamInfo& p : info.params) params[p.name] = param_axis(p);
  json out =
      object({{"technique", {{"const", info.name}}},
              {"params", object(params)},
              {"scene", axis(name(), "Scenes of this entry alone, in place of the sweep's.")},
              {"light", axis(name(), "Lights of this entry alone, in place of the sweep's.")},
              {"camera", axis(name(), "Cameras of this entry alone, in place of the sweep's.")},
              {"title", {{"type", "string"}, {"description", "Heading in the report's gallery."}}},
              {"caption", {{"type", "string"}, {"description", "What there is to see, in a sentence."}}}},
             {"technique"});
  out["description"] = info.title;
  return out;
}

json technique_entries(const Registry& registry) {
  std::vector<std::string> names;
  json alternatives = json::array();
  for (const TechniqueInfo& info : registry) {
    names.push_back(info.name);
    alternatives.push_back(technique_entry(info));
  }
  alternatives.insert(alternatives.begin(), choice(names));
  return axis({{"anyOf", alternatives}},
              "Techniques with their parameters; a parameter given a list is one more axis.");
}

json measure() {
  return object({{"warmup", integer(0, 1000)},
                 {"repetitions", integer(1, 100000)},
                 {"min_time_s", number(0, 86400)},
                 {"max_time_s", number(0.001, 86400)},
                 {"target_interval", number(0, 1)},
                 {"counters", {{"type", "boolean"}}}});
}

json axes(const Registry& registry) {
  json out = {
      {"scene", axis(name(), "Names under configs/scenes/, or paths of scene files.")},
      {"light", axis(name(), "Names of lights in the scenes; the first of the scene when left out.")},
      {"camera", axis(name(), "Names of cameras in the scenes; the first of the scene when left out.")},
      {"resolution", extent_axis(limits::resolution, "Pixels:")},
      {"mask_size", extent_axis(limits::mask_side, "Light samples in a grid:")},
      {"light_samples",
       axis(integer(1, limits::light_samples), "Light samples, any number, in place of mask_size.")},
      {"light_pattern", axis(choice(light_pattern_names()), "How light samples are placed.")},
      {"light_rotation",
       axis(choice(light_rotation_names()), "Whether each pixel moves the light samples in its own way.")},
      {"accumulate", axis(integer(1, limits::accumulate),
                          "Frames, each with another set of light samples, whose mean is the result.")},
      {"light_size", axis(number(0, limits::light_size),
                          "Rectangle: diagonal, sphere: diameter, in scene units; 0 makes a point light.")}};
  for (const std::string& axis_name : param_axis_names(registry))
    out[axis_name] = axis(integer(1, limits::grid_size),
                          fmt::format("The parameter {} of every technique that has it.", axis_name));
  return out;
}

// A top-level parameter axis: typed by the technique that marks it.
void type_param_axes(json& properties, const Registry& registry) {
  for (const TechniqueInfo& info : registry)
    for (const ParamInfo& p : info.params)
      if (p.axis && p.name != "grid_size") properties[p.name] = param_axis(p);
}

}  // namespace

json sweep_schema(const Registry& registry) {
  json properties = axes(registry);
  type_param_axes(properties, registry);
  properties["$schema"] = {{"type", "string"}};
  properties["name"] = {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-][A-Za-z0-9_.-]{0,99}$"}};
  properties["description"] = {{"type", "string"}};
  properties["techniques"] = technique_entries(registry);
  properties["reference"] = object({{"light_samples", integer(0, limits::reference_samples)}});
  properties["images"] = {{"type", "array"}, {"items", choice(image_names())}};
  properties["measure"] = measure();
  properties["frames"] = integer(1, limits::frames);
  properties["seed"] = integer(0, UINT32_MAX);
  json out = object(properties, {"scene", "techniques"});
  out["$schema"] = "http://json-schema.org/draft-07/schema#";
  out["title"] = "Penumbra sweep config";
  return out;
}

std::vector<SchemaFile> schema_files(const Registry& registry) {
  return {{"sweep", sweep_schema(registry)}, {"scene", scene_schema()}};
}

}  // namespace penumbra
