#include "app/describe_scene.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/scene.h"

namespace penumbra {
namespace {

using nlohmann::json;

// Six significant digits: floats as people write them.
double plain(float v) { return std::stod(fmt::format("{:.6g}", v)); }
json plain(Vec3f v) { return {plain(v.x), plain(v.y), plain(v.z)}; }

json to_json(const Light& light) {
  json out = {{"name", light.name}, {"kind", to_string(light.kind)}};
  if (light.kind != LightKind::directional) out["center"] = plain(light.center);
  if (light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle)
    out["sides"] = {plain(length(light.edge_u)), plain(length(light.edge_v))};
  if (light.kind == LightKind::sphere) out["radius"] = plain(light.radius);
  if (light.kind == LightKind::spot) out["cone_degrees"] = plain(light.cone_degrees);
  if (light.kind != LightKind::point && light.kind != LightKind::sphere && light.kind != LightKind::volume)
    out["direction"] = plain(light.direction);
  if (light.kind == LightKind::volume) out["points"] = light.points.size();
  return out;
}

json to_json(const Camera& camera) {
  return {{"name", camera.name},
          {"eye", plain(camera.eye)},
          {"target", plain(camera.target)},
          {"vertical_fov_degrees", plain(camera.vertical_fov_degrees)}};
}

json to_json(const SceneReport::MeshEntry& mesh) {
  const MeshHygiene& h = mesh.hygiene;
  const std::string origin = mesh.origin.substr(mesh.origin.find_last_of('/') + 1);
  return {{"name", mesh.name},
          {"origin", origin},
          {"dropped", h.dropped_index + h.dropped_not_finite + h.dropped_degenerate},
          {"closed", h.closed()},
          {"open_edges", h.open_edges},
          {"non_manifold_edges", h.non_manifold_edges},
          {"inconsistent_edges", h.inconsistent_edges}};
}

void print_text(const json& scene) {
  fmt::print("{}: {}\n{}, {} triangles{}\n", scene["name"].get<std::string>(),
             scene["description"].get<std::string>(), scene["fidelity"].get<std::string>(),
             scene["triangles"].dump(), scene["animated"] ? ", animated" : "");
  for (const char* part : {"meshes", "lights", "cameras"}) {
    fmt::print("{}:\n", part);
    for (json entry : scene[part]) {
      const std::string name = entry["name"];
      entry.erase("name");
      fmt::print("  {} {}\n", name, entry.dump());
    }
  }
}

}  // namespace

json scene_description(const Scene& scene) {
  const SceneReport report = scene.report();
  json meshes = json::array(), lights = json::array(), cameras = json::array();
  for (const auto& mesh : report.meshes) meshes.push_back(to_json(mesh));
  for (const std::string& name : scene.light_names()) lights.push_back(to_json(scene.light(name)));
  for (const std::string& name : scene.camera_names()) cameras.push_back(to_json(scene.camera(name)));
  const Box bounds = scene.frame(0, "", "", -1).geometry.bounds;
  return {{"name", report.name},
          {"description", report.description},
          {"fidelity", report.fidelity},
          {"triangles", report.triangles},
          {"animated", scene.animated()},
          {"bounds", {plain(bounds.lo), plain(bounds.hi)}},
          {"content_hash", scene.content_hash()},
          {"meshes", meshes},
          {"lights", lights},
          {"cameras", cameras}};
}

void describe_scene(const Context& context, const std::string& name, bool as_json) {
  const json out = scene_description(Scene::load(name, context.scene_search));
  if (as_json)
    fmt::print("{}\n", out.dump(2));
  else
    print_text(out);
}

}  // namespace penumbra
