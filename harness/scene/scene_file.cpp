#include "scene/scene_file.h"

#include <fmt/format.h>

#include <set>

namespace penumbra {

using namespace scene_file;

namespace {

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& entry : list) names.push_back(entry.name);
  return names;
}

std::string read_name(const JsonNode& node, const std::string& what) {
  const JsonNode name = node.require("name", what);
  const std::string text = name.string();
  if (text.empty()) name.fail("a name that is not empty");
  return text;
}

template <class List>
void check_unique(const JsonNode& node, const List& list, const std::string& name) {
  for (const auto& entry : list)
    if (entry.name == name) node.complain(fmt::format("the name '{}' is taken already.", name));
}

Subdivision read_subdivision(const JsonNode& node, bool moves) {
  node.allow_only({"loop", "target_triangles"}, "a subdivision");
  if (node.members().empty()) node.fail("\"loop\", \"target_triangles\" or both");
  if (moves) node.complain("a mesh that plays its keyframes cannot be subdivided.");
  Subdivision how;
  if (const auto loop = node.find("loop")) how.loop = static_cast<int>(loop->integer(0, 6));
  if (const auto target = node.find("target_triangles"))
    how.target_triangles = static_cast<std::size_t>(target->integer(1, 1 << 28));
  return how;
}

MeshSource read_mesh(const std::string& name, const JsonNode& node) {
  node.allow_only({"file", "generator", "params", "fit", "normals", "flip", "keyframes", "subdivide"},
                  "a mesh");
  MeshSource mesh;
  mesh.name = name;
  mesh.place = fmt::format("{}: {}", node.location(), node.pointer());
  if (node.has("file") == node.has("generator"))
    node.complain("a mesh has either \"file\" or \"generator\".");
  if (const auto file = node.find("file")) mesh.file = file->string();
  if (const auto generator = node.find("generator")) {
    std::vector<std::string> known;
    for (const GeneratorInfo& g : generators()) known.push_back(g.name);
    mesh.generator = generator->choice(known, "a generator's name");
  }
  if (const auto params = node.find("params")) {
    if (mesh.generator.empty()) params->complain("only generators have parameters.");
    for (const auto& [key, value] : params->members()) mesh.arguments.push_back({key, value.number()});
  }
  if (const auto fit = node.find("fit")) {
    fit->allow_only({"size", "ground"}, "a fit");
    mesh.fit = Fit{fit->require("size", "a fit").number(1e-6, 1e6), 0};
    if (const auto ground = fit->find("ground")) mesh.fit->ground = ground->number(-far_away, far_away);
  }
  if (const auto normals = node.find("normals"))
    mesh.recompute_normals = normals->choice({"file", "recompute"}, "where normals come from") == "recompute";
  if (const auto flip = node.find("flip")) mesh.flip = flip->boolean();
  if (const auto keys = node.find("keyframes")) {
    keys->allow_only({"first", "count", "frames_each"}, "keyframes of a mesh");
    if (mesh.file.empty()) keys->complain("only mesh files have keyframes.");
    if (const auto first = keys->find("first"))
      mesh.first_keyframe = static_cast<int>(first->integer(0, 100000));
    mesh.keyframes = static_cast<int>(keys->require("count", "keyframes of a mesh").integer(1, 10000));
    if (const auto each = keys->find("frames_each")) mesh.frames_per_keyframe = each->number(1e-3, 1e6);
  }
  if (const auto how = node.find("subdivide")) mesh.subdivide = read_subdivision(*how, mesh.keyframes > 1);
  return mesh;
}

Mat4d read_matrix(const JsonNode& node) {
  if (!node.is_array() || node.items().size() != 4) node.fail("four rows of four numbers");
  Mat4d m;
  const std::vector<JsonNode> rows = node.items();
  for (int r = 0; r < 4; ++r) {
    const std::vector<double> row = rows[static_cast<std::size_t>(r)].numbers(4);
    for (int c = 0; c < 4; ++c) m[c][r] = row[static_cast<std::size_t>(c)];
  }
  if (m[0].w != 0 || m[1].w != 0 || m[2].w != 0 || m[3].w != 1) rows[3].fail("[0, 0, 0, 1]");
  return m;
}

Mat4d read_step(const JsonNode& step) {
  step.allow_only({"translate", "rotate", "scale", "matrix"}, "a step of a transform");
  if (step.members().size() != 1) step.fail("one of translate, rotate, scale, matrix in each step");
  const auto [key, value] = step.members().front();
  if (key == "translate") return translation(read_point(value));
  if (key == "matrix") return read_matrix(value);
  if (key == "scale") {
    if (value.is_number()) {
      const double s = value.number(-far_away, far_away);
      return scaling({s, s, s});
    }
    return scaling(read_point(value));
  }
  value.allow_only({"axis", "degrees"}, "a rotation");
  return rotation(read_direction(value.require("axis", "a rotation")),
                  value.require("degrees", "a rotation").number(-1e6, 1e6));
}

InstanceSource read_instance(const JsonNode& node, const SceneFile& scene) {
  const std::string what = "an instance";
  node.allow_only({"name", "mesh", "transform", "albedo", "grid"}, what);
  InstanceSource instance;
  instance.mesh = read_reference(node.require("mesh", what), scene.mesh_names(), "a mesh of this scene");
  instance.name = node.has("name") ? read_name(node, what) : scene.meshes[instance.mesh].name;
  check_unique(node, scene.instances, instance.name);
  if (const auto transform = node.find("transform")) {
    for (const JsonNode& step : transform->items())
      instance.world_from_mesh = read_step(step) * instance.world_from_mesh;
    const Mat4d& m = instance.world_from_mesh;
    if (dot(m[0].xyz(), cross(m[1].xyz(), m[2].xyz())) == 0)
      transform->complain("the transform flattens the mesh (its determinant is 0).");
  }
  if (const auto albedo = node.find("albedo")) {
    const std::vector<double> rgb = albedo->numbers(3);
    for (std::size_t i = 0; i < 3; ++i) {
      albedo->items()[i].number(0, 1);
      instance.albedo[static_cast<int>(i)] = static_cast<float>(rgb[i]);
    }
  }
  if (const auto grid = node.find("grid")) {
    grid->allow_only({"counts", "spacing"}, "a grid of instances");
    const JsonNode counts = grid->require("counts", "a grid of instances");
    (void)counts.numbers(3);
    for (std::size_t i = 0; i < 3; ++i)
      instance.counts[i] = static_cast<int>(counts.items()[i].integer(1, 10000));
    instance.spacing = read_point(grid->require("spacing", "a grid of instances"));
  }
  return instance;
}

void read_defaults(const JsonNode& node, SceneFile& scene) {
  static const std::vector<std::string> axes = {"resolution", "mask_size", "light_samples", "light_pattern",
                                                "light_size", "grid_size", "map_size"};
  node.allow_only(axes, "the axes' defaults");
  for (const auto& [axis, value] : node.members()) {
    if (axis == "light_pattern")
      (void)value.choice({"regular", "jittered", "halton"}, "a light pattern");
    else if (axis == "light_size")
      (void)value.number(0, far_away);
    else if ((axis == "resolution" || axis == "mask_size") && value.is_array()) {
      (void)value.numbers(2);
      for (const JsonNode& n : value.items()) (void)n.integer(1, 65536);
    } else
      (void)value.integer(1, 65536);
    scene.axis_defaults[axis] = value.json().dump();
  }
}

void read_lights_and_cameras(const JsonNode& root, SceneFile& scene) {
  for (const JsonNode& node : root.require("lights", "a scene").items()) {
    Light light = read_light(node);
    check_unique(node, scene.lights, light.name);
    scene.lights.push_back(std::move(light));
  }
  if (scene.lights.empty()) root.require("lights", "a scene").fail("at least one light");
  for (const JsonNode& node : root.require("cameras", "a scene").items()) {
    Camera camera = read_camera(node);
    check_unique(node, scene.cameras, camera.name);
    scene.cameras.push_back(std::move(camera));
  }
  if (scene.cameras.empty()) root.require("cameras", "a scene").fail("at least one camera");
}

}  // namespace

std::size_t InstanceSource::copies() const {
  return static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]) *
         static_cast<std::size_t>(counts[2]);
}

std::vector<std::string> SceneFile::mesh_names() const { return names_of(meshes); }
std::vector<std::string> SceneFile::instance_names() const { return names_of(instances); }
std::vector<std::string> SceneFile::light_names() const { return names_of(lights); }
std::vector<std::string> SceneFile::camera_names() const { return names_of(cameras); }

Vec3d scene_file::read_point(const JsonNode& node) {
  const std::vector<double> v = node.numbers(3);
  for (const JsonNode& n : node.items()) (void)n.number(-far_away, far_away);
  return {v[0], v[1], v[2]};
}

Vec3d scene_file::read_direction(const JsonNode& node) {
  const Vec3d v = normalize(read_point(node));
  if (v == Vec3d{}) node.fail("a direction that is not zero");
  return v;
}

std::size_t scene_file::read_reference(const JsonNode& node, const std::vector<std::string>& names,
                                       const std::string& what) {
  const std::string name = node.choice(names, what);
  std::size_t index = 0;
  while (names[index] != name) ++index;
  return index;
}

SceneFile parse_scene_file(const JsonDocument& document) {
  const JsonNode root = document.root();
  root.allow_only({"$schema", "name", "description", "fidelity", "meshes", "instances", "lights", "cameras",
                   "defaults", "animation"},
                  "a scene");
  SceneFile scene;
  scene.document = document;
  scene.name = read_name(root, "a scene");
  if (const auto text = root.find("description")) scene.description = text->string();
  if (const auto fidelity = root.find("fidelity"))
    scene.fidelity =
        fidelity->choice({"exact", "stand-in", "procedural"}, "how true to its source the scene is");
  for (const auto& [name, node] : root.require("meshes", "a scene").members())
    scene.meshes.push_back(read_mesh(name, node));
  for (const JsonNode& node : root.require("instances", "a scene").items())
    scene.instances.push_back(read_instance(node, scene));
  if (scene.instances.empty()) root.require("instances", "a scene").fail("at least one instance");
  read_lights_and_cameras(root, scene);
  if (const auto defaults = root.find("defaults")) read_defaults(*defaults, scene);
  if (const auto animation = root.find("animation")) scene.animation = read_animation(*animation, scene);
  return scene;
}

}  // namespace penumbra
