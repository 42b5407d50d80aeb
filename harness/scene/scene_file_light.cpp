// Lights and cameras of a scene file.
#include <fmt/format.h>

#include <cmath>

#include "core/radical_inverse.h"
#include "scene/scene_file.h"

namespace penumbra::scene_file {
namespace {

const std::vector<std::string> kinds = {"point",  "directional",        "spot",  "rectangle",
                                        "sphere", "textured_rectangle", "volume"};

// Keys of each kind besides name, kind and intensity.
std::vector<std::string> keys_of(LightKind kind) {
  std::vector<std::string> keys = {"name", "kind", "intensity"};
  const auto add = [&](std::initializer_list<const char*> more) {
    keys.insert(keys.end(), more.begin(), more.end());
  };
  switch (kind) {
    case LightKind::point:
      add({"center"});
      break;
    case LightKind::directional:
      add({"direction"});
      break;
    case LightKind::spot:
      add({"center", "direction", "target", "cone_degrees"});
      break;
    case LightKind::textured_rectangle:
      add({"texture"});
      [[fallthrough]];
    case LightKind::rectangle:
      add({"center", "direction", "target", "up", "width", "height", "edge_u", "edge_v"});
      break;
    case LightKind::sphere:
      add({"center", "radius"});
      break;
    case LightKind::volume:
      add({"points", "ellipsoid", "weights"});
      break;
  }
  return keys;
}

// Where a light at `center` points: "direction", or towards "target".
Vec3d read_aim(const JsonNode& node, Vec3d center) {
  if (node.has("direction") == node.has("target"))
    node.complain("expected either \"direction\" or \"target\".");
  if (const auto direction = node.find("direction")) return read_direction(*direction);
  const JsonNode target = *node.find("target");
  const Vec3d d = normalize(read_point(target) - center);
  if (d == Vec3d{}) target.fail("a target away from the light's centre");
  return d;
}

void read_edges(const JsonNode& node, Light& light) {
  for (const char* key : {"direction", "target", "up", "width", "height"})
    if (const auto extra = node.find(key))
      extra->complain(
          "a rectangle is given by edge_u and edge_v, or by its width, height and aim, not by both.");
  const JsonNode v_node = node.require("edge_v", "a rectangle given by its edges");
  const Vec3d u = read_point(node.require("edge_u", "a rectangle given by its edges")),
              v = read_point(v_node);
  if (length(cross(u, v)) == 0) v_node.fail("edges that span a rectangle");
  if (std::abs(dot(u, v)) > 1e-5 * length(u) * length(v)) v_node.fail("an edge at a right angle to edge_u");
  light.edge_u = Vec3f(u), light.edge_v = Vec3f(v);
  light.direction = Vec3f(normalize(cross(u, v)));
}

void read_rectangle(const JsonNode& node, Light& light) {
  const Vec3d center = read_point(node.require("center", "a rectangle light"));
  light.center = Vec3f(center);
  if (node.has("edge_u") || node.has("edge_v")) return read_edges(node, light);
  const Vec3d n = read_aim(node, center);
  Vec3d up{0, 1, 0};
  if (const auto given = node.find("up")) {
    up = read_direction(*given);
    if (length(cross(up, n)) < 1e-6) given->fail("a direction that is not the light's own");
  } else if (length(cross(up, n)) < 1e-6) {
    up = {0, 0, 1};
  }
  const Vec3d u = normalize(cross(up, n)), v = cross(n, u);
  light.edge_u = Vec3f(u * node.require("width", "a rectangle light").number(1e-6, 1e6));
  light.edge_v = Vec3f(v * node.require("height", "a rectangle light").number(1e-6, 1e6));
  light.direction = Vec3f(n);
}

// Weights of a list, at least one of them positive.
std::vector<float> read_weights(const JsonNode& node, std::size_t count) {
  std::vector<float> weights;
  double sum = 0;
  for (const JsonNode& n : node.items())
    weights.push_back(static_cast<float>(n.number(0, 1e9))), sum += n.number();
  if (weights.size() != count) node.fail(fmt::format("{} weights", count));
  if (!(sum > 0)) node.fail("a weight above 0");
  return weights;
}

void read_texture(const JsonNode& node, Light& light) {
  node.allow_only({"width", "height", "weights"}, "a light's texture");
  light.texture_width = static_cast<int>(node.require("width", "a light's texture").integer(1, 4096));
  light.texture_height = static_cast<int>(node.require("height", "a light's texture").integer(1, 4096));
  light.weights = read_weights(
      node.require("weights", "a light's texture"),
      static_cast<std::size_t>(light.texture_width) * static_cast<std::size_t>(light.texture_height));
}

// So many points of an ellipsoid, spread evenly: those of a Halton sequence in its box that lie in it.
std::vector<Vec3d> read_ellipsoid(const JsonNode& node) {
  const char* what = "an ellipsoid of points";
  node.allow_only({"center", "half_axes", "count"}, what);
  const Vec3d center = read_point(node.require("center", what));
  const JsonNode axes_node = node.require("half_axes", what);
  const Vec3d axes = read_point(axes_node);
  if (!(axes.x > 0 && axes.y > 0 && axes.z > 0)) axes_node.fail("three lengths above 0");
  const auto count = static_cast<std::size_t>(node.require("count", what).integer(1, 32768));
  std::vector<Vec3d> points;
  for (uint32_t i = 1; points.size() < count; ++i) {
    const Vec3d unit{2 * radical_inverse(i, 2) - 1, 2 * radical_inverse(i, 3) - 1,
                     2 * radical_inverse(i, 5) - 1};
    if (dot(unit, unit) <= 1)
      points.push_back(center + Vec3d{unit.x * axes.x, unit.y * axes.y, unit.z * axes.z});
  }
  return points;
}

void read_volume(const JsonNode& node, Light& light) {
  if (node.has("points") == node.has("ellipsoid"))
    node.complain("expected either \"points\" or \"ellipsoid\".");
  std::vector<Vec3d> points;
  if (const auto ellipsoid = node.find("ellipsoid")) {
    points = read_ellipsoid(*ellipsoid);
  } else {
    const JsonNode list = *node.find("points");
    for (const JsonNode& p : list.items()) points.push_back(read_point(p));
    if (points.empty()) list.fail("at least one point");
  }
  Vec3d sum{};
  for (const Vec3d& p : points) light.points.push_back(Vec3f(p)), sum += p;
  light.center = Vec3f(sum / double(light.points.size()));
  light.weights.assign(light.points.size(), 1.0f);
  if (const auto weights = node.find("weights")) light.weights = read_weights(*weights, light.points.size());
}

}  // namespace

Light read_light(const JsonNode& node) {
  const std::string what = "a light";
  if (!node.is_object()) node.fail("a light");
  const JsonNode kind_node = node.require("kind", what);
  Light light;
  light.kind = static_cast<LightKind>(read_reference(kind_node, kinds, "a kind of light"));
  node.allow_only(keys_of(light.kind), fmt::format("a {} light", to_string(light.kind)));
  light.name = node.require("name", what).string();
  if (const auto intensity = node.find("intensity"))
    light.intensity = static_cast<float>(intensity->number(0, 1e9));
  switch (light.kind) {
    case LightKind::point:
      light.center = Vec3f(read_point(node.require("center", what)));
      break;
    case LightKind::directional:
      light.direction = Vec3f(read_direction(node.require("direction", what)));
      break;
    case LightKind::spot: {
      const Vec3d center = read_point(node.require("center", what));
      light.center = Vec3f(center);
      light.direction = Vec3f(read_aim(node, center));
      if (const auto cone = node.find("cone_degrees"))
        light.cone_degrees = static_cast<float>(cone->number(0.1, 89));
      break;
    }
    case LightKind::textured_rectangle:
      read_texture(node.require("texture", what), light);
      [[fallthrough]];
    case LightKind::rectangle:
      read_rectangle(node, light);
      break;
    case LightKind::sphere:
      light.center = Vec3f(read_point(node.require("center", what)));
      light.radius = static_cast<float>(node.require("radius", what).number(1e-6, 1e6));
      break;
    case LightKind::volume:
      read_volume(node, light);
      break;
  }
  return light;
}

Camera read_camera(const JsonNode& node) {
  node.allow_only({"name", "eye", "target", "up", "vertical_fov_degrees", "near_plane"}, "a camera");
  Camera camera;
  camera.name = node.require("name", "a camera").string();
  const JsonNode target = node.require("target", "a camera");
  camera.eye = Vec3f(read_point(node.require("eye", "a camera")));
  camera.target = Vec3f(read_point(target));
  const Vec3d forward = normalize(Vec3d(camera.target) - Vec3d(camera.eye));
  if (forward == Vec3d{}) target.fail("a target away from the eye");
  const auto up = node.find("up");
  if (up) camera.up = Vec3f(read_direction(*up));
  if (length(cross(forward, Vec3d(camera.up))) < 1e-6)
    (up ? *up : target).complain("the camera looks along its up direction: give another \"up\".");
  if (const auto fov = node.find("vertical_fov_degrees"))
    camera.vertical_fov_degrees = static_cast<float>(fov->number(0.1, 179));
  if (const auto near = node.find("near_plane"))
    camera.near_plane = static_cast<float>(near->number(1e-6, 1e6));
  return camera;
}

}  // namespace penumbra::scene_file
