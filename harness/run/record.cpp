#include "run/record.h"

#include <fmt/format.h>

#include "config/sweep.h"
#include "core/hash.h"

namespace penumbra::run {
namespace {

ParamValue param_value(const nlohmann::json& json) {
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_integer()) return json.get<int64_t>();
  if (json.is_number()) return json.get<double>();
  return json.get<std::string>();
}

}  // namespace

nlohmann::json to_json(const Point& p) {
  nlohmann::json params = nlohmann::json::object();
  for (const auto& [name, value] : p.params) params[name] = param_to_json(value);
  return {{"id", p.id},
          {"technique", p.technique},
          {"params", params},
          {"scene", p.scene},
          {"light", p.light},
          {"camera", p.camera},
          {"width", p.width},
          {"height", p.height},
          {"samples_width", p.light_samples.width},
          {"samples_height", p.light_samples.height},
          {"samples_count", p.light_samples.count},
          {"samples_pattern", static_cast<int>(p.light_samples.pattern)},
          {"samples_rotation", static_cast<int>(p.light_samples.rotation)},
          {"accumulate", p.accumulate},
          {"samples_seed", p.light_samples.seed},
          {"sampled", p.sampled},
          {"light_size", p.light_size},
          {"frame", p.frame},
          {"seed", p.seed},
          {"title", p.title},
          {"caption", p.caption},
          {"invocation", p.invocation}};
}

Point point_from_json(const nlohmann::json& j) {
  Point p;
  p.id = j.at("id");
  p.technique = j.at("technique");
  for (const auto& [name, value] : j.at("params").items()) p.params[name] = param_value(value);
  p.scene = j.at("scene");
  p.light = j.at("light");
  p.camera = j.at("camera");
  p.width = j.at("width");
  p.height = j.at("height");
  p.light_samples.width = j.at("samples_width");
  p.light_samples.height = j.at("samples_height");
  p.light_samples.count = j.at("samples_count");
  p.light_samples.pattern = static_cast<LightPattern>(j.at("samples_pattern").get<int>());
  p.light_samples.rotation = static_cast<LightRotation>(j.at("samples_rotation").get<int>());
  p.accumulate = j.at("accumulate");
  p.light_samples.seed = j.at("samples_seed");
  p.sampled = j.at("sampled");
  p.light_size = j.at("light_size");
  p.frame = j.at("frame");
  p.seed = j.at("seed");
  p.title = j.at("title");
  p.caption = j.at("caption");
  p.invocation = j.at("invocation");
  return p;
}

nlohmann::json record_of(const Point& p) {
  nlohmann::json params = nlohmann::json::object();
  params["resolution"] = {p.width, p.height};
  params["light"] = p.light;
  params["camera"] = p.camera;
  params["light_size"] = p.light_size < 0 ? nlohmann::json() : nlohmann::json(p.light_size);
  params["seed"] = p.seed;
  if (p.sampled) {
    if (p.light_samples.count > 0)
      params["light_samples"] = p.light_samples.count;
    else
      params["mask_size"] = extent_to_json(p.light_samples.width, p.light_samples.height);
    params["light_pattern"] = light_pattern_names()[static_cast<std::size_t>(p.light_samples.pattern)];
    if (p.light_samples.rotation != LightRotation::none)
      params["light_rotation"] = light_rotation_names()[static_cast<std::size_t>(p.light_samples.rotation)];
    if (p.accumulate > 1) params["accumulate"] = p.accumulate;
  }
  for (const auto& [name, value] : p.params) params[name] = param_to_json(value);
  nlohmann::json record = {{"id", p.id},       {"technique", p.technique}, {"scene", p.scene},
                           {"frame", p.frame}, {"params", params},         {"command", p.command()},
                           {"key", p.key()}};
  if (!p.title.empty()) record["title"] = p.title;
  if (!p.caption.empty()) record["caption"] = p.caption;
  return record;
}

nlohmann::json record_without_result(const Point& point, std::string_view status,
                                     const std::string& message) {
  nlohmann::json record = record_of(point);
  record["status"] = status;
  record["message"] = message;
  return record;
}

std::string sequence_key(const Point& point) {
  nlohmann::json j = to_json(point);
  for (const char* not_of_the_sequence : {"id", "frame", "title", "caption", "invocation"})
    j.erase(not_of_the_sequence);
  return Hasher().text(j.dump()).hex().substr(0, 16);
}

std::string view_key(const Point& p) {
  return Hasher().text(p.scene).text(p.camera).value(p.width).value(p.height).value(p.frame).hex().substr(0,
                                                                                                          16);
}

std::string dump_line(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace penumbra::run
