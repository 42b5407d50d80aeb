// A scene: meshes, instances, lights, cameras and how they move. A Frame is one moment of it, flattened to
// world space; techniques only ever see Frames.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/mesh.h"

namespace penumbra {

// World-space triangles of one frame. Triangle t has corners indices[3t .. 3t+2]; vertices are not shared
// between instances. Topology (indices) is the same in all frames of a scene.
struct Geometry {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  // shading normals, unit, per vertex
  std::vector<uint32_t> indices;
  std::vector<uint32_t> triangle_instance;
  std::vector<Vec3f> instance_albedo;
  Box bounds;
  bool closed = false;  // every instance's mesh is closed and consistently wound (mirrored ones stay so)
  std::vector<uint8_t> instance_closed;  // the same, one by one
  std::size_t triangle_count() const { return indices.size() / 3; }
  // The triangle belongs to an instance whose mesh is closed.
  bool in_closed_mesh(std::size_t triangle) const {
    const std::size_t instance = triangle_instance.empty() ? 0 : triangle_instance[triangle];
    return instance < instance_closed.size() ? instance_closed[instance] != 0 : closed;
  }
  Vec3f corner(std::size_t triangle, int i) const {
    return positions[indices[3 * triangle + static_cast<std::size_t>(i)]];
  }
};

// What differs from the previous frame that a technique was told about.
struct Changes {
  bool topology = true;  // first frame: everything is new
  bool positions = true;
  bool light = true;
  bool camera = true;
  bool any() const { return topology || positions || light || camera; }
};

struct Frame {
  int index = 0;
  Geometry geometry;
  Light light;
  Camera camera;
  Changes changes;
};

struct SceneReport {                        // for run.json and the report page
  std::string name, description, fidelity;  // fidelity: "exact", "stand-in" or "procedural"
  std::size_t triangles = 0;
  struct MeshEntry {
    std::string name, origin;
    MeshHygiene hygiene;
  };
  std::vector<MeshEntry> meshes;
};

class Scene {
 public:
  // `name_or_path`: a name under configs/scenes/ (in any of `search`), or a path to a scene file.
  // Errors: InputError with file, line and JSON pointer; a missing mesh says which command fetches it.
  static Scene load(const std::string& name_or_path, const std::vector<std::filesystem::path>& search);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const std::string& name() const;
  std::vector<std::string> light_names() const;       // the first is the default
  std::vector<std::string> camera_names() const;      // the first is the default
  const Light& light(const std::string& name) const;  // empty name = default; InputError with nearest name
  const Camera& camera(const std::string& name) const;
  bool animated() const;
  // Value the scene file gives for a sweep axis (resolution, mask_size, light_size, ...), as JSON text; "" if
  // none.
  std::string axis_default(const std::string& axis) const;
  SceneReport report() const;
  // Hash of everything that determines frames: the file, the meshes' contents, generator versions.
  std::string content_hash() const;

  // Frame `index` >= 0 of the animation (0 where nothing moves). `light_size` < 0 keeps the scene's own size.
  // `previous`: the frame that consumers last saw, or null; fills Frame::changes.
  Frame frame(int index, const std::string& light, const std::string& camera, float light_size,
              const Frame* previous = nullptr) const;

 private:
  struct Impl;
  explicit Scene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace penumbra
