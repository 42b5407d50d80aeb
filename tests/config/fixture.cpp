#include "fixture.h"

namespace penumbra::test {
namespace {

ParamInfo param(const std::string& name, ParamType type, ParamValue fallback, double lo, double hi,
                std::vector<std::string> choices = {}) {
  ParamInfo info;
  info.name = name, info.type = type, info.fallback = std::move(fallback), info.lo = lo, info.hi = hi;
  info.choices = std::move(choices);
  return info;
}

Light light(LightKind kind, const std::string& name) {
  Light l;
  l.kind = kind, l.name = name;
  l.edge_u = {3, 0, 0}, l.edge_v = {0, 0, 4}, l.radius = 1;
  return l;
}

Registry make_registry() {
  TechniqueInfo gears, shadow_map, ray_tracing;
  gears.name = "gears", gears.sampled = true;
  gears.params = {
      param("grid_size", ParamType::integer, int64_t{128}, 8, 1024),
      param("assignment", ParamType::choice, std::string("clusters"), 0, 0, {"triangles", "clusters"})};
  gears.params[0].axis = true;
  shadow_map.name = "shadow_map";
  shadow_map.params = {param("map_size", ParamType::integer, int64_t{1024}, 16, 16384),
                       param("slope_bias", ParamType::number, 2.0, 0, 64)};
  ray_tracing.name = "ray_tracing", ray_tracing.sampled = true;
  ray_tracing.params = {param("dynamic", ParamType::boolean, false, 0, 1)};
  return {gears, shadow_map, ray_tracing};
}

}  // namespace

const Registry& registry() {
  static const Registry all = make_registry();
  return all;
}

SceneDeclaration declare(const std::string& name) {
  SceneDeclaration scene;
  scene.name = name, scene.file = name + ".json";
  scene.cameras = {"front"};
  if (name == "lamp") {
    scene.lights = {light(LightKind::point, "spark")};
    return scene;
  }
  if (name != "area" && name != "defaults") throw InputError("unknown scene '" + name + "'.");
  scene.lights = {light(LightKind::rectangle, "key"), light(LightKind::sphere, "bulb"),
                  light(LightKind::point, "spark")};
  scene.cameras.emplace_back("side");
  if (name == "defaults")
    scene.axis_defaults = {{"resolution", "[640, 360]"}, {"mask_size", "[16, 8]"},
                           {"light_size", "0.5"},        {"grid_size", "64"},
                           {"map_size", "2048"},         {"light_pattern", "\"halton\""}};
  return scene;
}

std::vector<Point> expand_text(const std::string& config) {
  return expand(parse_sweep(JsonDocument::parse(config, "c.json"), registry(), "c"), declare);
}

std::vector<std::string> keys(const std::vector<Point>& points) {
  std::vector<std::string> out;
  for (const Point& p : points) out.push_back(p.key());
  return out;
}

std::string error_of_config(const std::string& config) {
  try {
    (void)expand_text(config);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace penumbra::test
