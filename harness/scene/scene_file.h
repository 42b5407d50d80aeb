// A scene file, parsed and checked, nothing loaded yet. The format is described in configs/scenes/README.md.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/json_text.h"
#include "core/vec.h"
#include "scene/animation.h"
#include "scene/camera.h"
#include "scene/generators.h"
#include "scene/light.h"
#include "scene/subdivision.h"

namespace penumbra {

// Uniform scale to `size` along the longest side, centred over the origin in x and z, lowest point at y =
// ground.
struct Fit {
  double size = 1, ground = 0;
};

struct MeshSource {
  std::string name;
  std::string place;  // "file:line:column: /pointer", opens messages about it
  std::string file;   // or:
  std::string generator;
  std::vector<GeneratorArgument> arguments;
  std::optional<Fit> fit;
  Subdivision subdivide;  // before the fit
  bool recompute_normals = false;
  bool flip = false;                      // turns every triangle round: rooms seen from inside
  int first_keyframe = 0, keyframes = 1;  // of a file that has them
  double frames_per_keyframe = 1;
};

struct InstanceSource {
  std::string name;
  std::size_t mesh = 0;
  Mat4d world_from_mesh;
  Vec3f albedo{0.75f, 0.75f, 0.75f};
  int counts[3] = {1, 1, 1};  // grid, centred about the instance's place
  Vec3d spacing;
  std::size_t copies() const;
};

struct SceneFile {
  std::string name, description, fidelity = "procedural";
  std::vector<MeshSource> meshes;
  std::vector<InstanceSource> instances;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  Animation animation;
  std::map<std::string, std::string> axis_defaults;  // axis -> JSON text
  JsonDocument document;

  std::vector<std::string> mesh_names() const, instance_names() const, light_names() const,
      camera_names() const;
};

// Throws InputError.
SceneFile parse_scene_file(const JsonDocument& document);

// Parts of the parser, one file each.
namespace scene_file {
inline constexpr double far_away = 1e9;      // no coordinate of a scene lies beyond
Vec3d read_point(const JsonNode& node);      // three numbers within +-1e9
Vec3d read_direction(const JsonNode& node);  // not zero; unit
Light read_light(const JsonNode& node);
Camera read_camera(const JsonNode& node);
Animation read_animation(const JsonNode& node, const SceneFile& scene);
// Index of the name that `node` holds among `names`; `what` for the message: "a mesh of this scene".
std::size_t read_reference(const JsonNode& node, const std::vector<std::string>& names,
                           const std::string& what);
}  // namespace scene_file

}  // namespace penumbra
