#include "scene/scene_schema.h"

#include "scene/generators.h"

namespace penumbra {
namespace {

using nlohmann::json;

json text() { return {{"type", "string"}, {"minLength", 1}}; }
json number() { return {{"type", "number"}}; }
json above_zero() { return {{"type", "number"}, {"exclusiveMinimum", 0}}; }
json integer(int lo, int hi) { return {{"type", "integer"}, {"minimum", lo}, {"maximum", hi}}; }
json choice(std::initializer_list<const char*> names) {
  return {{"enum", json(std::vector<std::string>(names.begin(), names.end()))}};
}

json list(const json& items, int least = 0) {
  json out = {{"type", "array"}, {"items", items}};
  if (least > 0) out["minItems"] = least;
  return out;
}

json tuple(const json& items, int count) {
  return {{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
}

json object(const json& properties, const std::vector<std::string>& required = {}) {
  json out = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) out["required"] = required;
  return out;
}

const json point = tuple(number(), 3);

json generator_mesh(const GeneratorInfo& g, const json& common) {
  json params = json::object();
  for (const GeneratorInfo::Param& p : g.params)
    params[p.name] = {{"type", p.integer ? "integer" : "number"},
                      {"minimum", p.lo},
                      {"maximum", p.hi},
                      {"default", p.fallback},
                      {"description", p.help}};
  json properties = common;
  properties["generator"] = {{"const", g.name}, {"description", g.help + " Triangles: " + g.triangles + "."}};
  properties["params"] = object(params);
  return object(properties, {"generator"});
}

json mesh() {
  const json common = {
      {"fit", object({{"size", above_zero()}, {"ground", number()}}, {"size"})},
      {"normals", choice({"file", "recompute"})},
      {"flip", {{"type", "boolean"}}},
      {"subdivide", object({{"loop", integer(0, 6)}, {"target_triangles", integer(1, 1 << 28)}})}};
  json file = common;
  file["file"] = text();
  file["keyframes"] =
      object({{"first", integer(0, 100000)}, {"count", integer(1, 10000)}, {"frames_each", above_zero()}},
             {"count"});
  json any = json::array({object(file, {"file"})});
  for (const GeneratorInfo& g : generators()) any.push_back(generator_mesh(g, common));
  return {{"anyOf", any}};
}

json instance() {
  const json step = {
      {"anyOf", json::array({object({{"translate", point}}, {"translate"}),
                             object({{"scale", {{"anyOf", json::array({number(), point})}}}}, {"scale"}),
                             object({{"rotate",
                                      object({{"axis", point}, {"degrees", number()}}, {"axis", "degrees"})}},
                                    {"rotate"}),
                             object({{"matrix", tuple(tuple(number(), 4), 4)}}, {"matrix"})})}};
  return object({{"name", text()},
                 {"mesh", text()},
                 {"transform", list(step)},
                 {"albedo", tuple({{"type", "number"}, {"minimum", 0}, {"maximum", 1}}, 3)},
                 {"grid", object({{"counts", tuple(integer(1, 10000), 3)}, {"spacing", point}},
                                 {"counts", "spacing"})}},
                {"mesh"});
}

json light_of(const char* kind, json properties, std::vector<std::string> required) {
  properties["name"] = text();
  properties["kind"] = {{"const", kind}};
  properties["intensity"] = {{"type", "number"}, {"minimum", 0}};
  required.insert(required.end(), {"name", "kind"});
  return object(properties, required);
}

json light() {
  const json rectangle = {{"center", point}, {"direction", point},    {"target", point},
                          {"up", point},     {"width", above_zero()}, {"height", above_zero()},
                          {"edge_u", point}, {"edge_v", point}};
  const json weights = list({{"type", "number"}, {"minimum", 0}}, 1);
  json textured = rectangle;
  textured["texture"] =
      object({{"width", integer(1, 4096)}, {"height", integer(1, 4096)}, {"weights", weights}},
             {"width", "height", "weights"});
  const json spot = {{"center", point},
                     {"direction", point},
                     {"target", point},
                     {"cone_degrees", {{"type", "number"}, {"minimum", 0.1}, {"maximum", 89}}}};
  const json ellipsoid = object({{"center", point}, {"half_axes", point}, {"count", integer(1, 32768)}},
                                {"center", "half_axes", "count"});
  return {
      {"anyOf",
       json::array({light_of("point", {{"center", point}}, {"center"}),
                    light_of("directional", {{"direction", point}}, {"direction"}),
                    light_of("spot", spot, {"center"}), light_of("rectangle", rectangle, {"center"}),
                    light_of("sphere", {{"center", point}, {"radius", above_zero()}}, {"center", "radius"}),
                    light_of("textured_rectangle", textured, {"center", "texture"}),
                    light_of("volume", {{"points", list(point, 1)}, {"weights", weights}}, {"points"}),
                    light_of("volume", {{"ellipsoid", ellipsoid}, {"weights", weights}}, {"ellipsoid"})})}};
}

json camera() {
  return object(
      {{"name", text()},
       {"eye", point},
       {"target", point},
       {"up", point},
       {"vertical_fov_degrees", {{"type", "number"}, {"minimum", 0.1}, {"maximum", 179}, {"default", 45}}},
       {"near_plane", {{"type", "number"}, {"minimum", 1e-6}, {"default", 0.01}}}},
      {"name", "eye", "target"});
}

// `target`: the key that names what moves.
json track(const char* target, json keyframe, const json& more = json::object()) {
  keyframe["frame"] = {{"type", "number"}, {"minimum", 0}};
  json properties = more;
  properties[target] = text();
  properties["loop"] = {{"type", "boolean"}};
  properties["keyframes"] = list(object(keyframe, {"frame"}), 1);
  return list(object(properties, {target, "keyframes"}));
}

json animation() {
  const json axis = choice({"x", "y", "z"});
  const json deformation = object({{"instance", text()},
                                   {"kind", choice({"twist", "bend", "wave"})},
                                   {"axis", axis},
                                   {"direction", axis},
                                   {"amplitude", number()},
                                   {"period", above_zero()},
                                   {"wavelength", above_zero()}},
                                  {"instance", "kind", "amplitude", "period"});
  return object(
      {{"cameras", track("camera", {{"eye", point}, {"target", point}})},
       {"lights", track("light", {{"center", point}, {"direction", point}})},
       {"instances", track("instance", {{"translate", point}, {"degrees", number()}, {"scale", above_zero()}},
                           {{"axis", point}, {"pivot", point}})},
       {"deformations", list(deformation)}});
}

json defaults() {
  const json count = integer(1, 65536);
  const json extent = {{"anyOf", json::array({count, tuple(count, 2)})}};
  return object({{"resolution", extent},
                 {"mask_size", extent},
                 {"light_samples", count},
                 {"light_pattern", choice({"regular", "jittered", "halton"})},
                 {"light_size", {{"type", "number"}, {"minimum", 0}}},
                 {"grid_size", count},
                 {"map_size", count}});
}

}  // namespace

json scene_schema() {
  json out = object({{"$schema", {{"type", "string"}}},
                     {"name", text()},
                     {"description", {{"type", "string"}}},
                     {"fidelity", choice({"exact", "stand-in", "procedural"})},
                     {"meshes", {{"type", "object"}, {"additionalProperties", mesh()}}},
                     {"instances", list(instance(), 1)},
                     {"lights", list(light(), 1)},
                     {"cameras", list(camera(), 1)},
                     {"defaults", defaults()},
                     {"animation", animation()}},
                    {"name", "meshes", "instances", "lights", "cameras"});
  out["$schema"] = "http://json-schema.org/draft-07/schema#";
  out["title"] = "Penumbra scene";
  return out;
}

}  // namespace penumbra
