#include "scene/scene.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "scene/declaration.h"
#include "scene/generator_table.h"
#include "scene/mesh_search.h"
#include "scene/scene_file.h"
#include "scene/scene_mesh.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t grain = 8192;

// One copy of a mesh in the flattened geometry.
struct Placed {
  std::size_t instance = 0, mesh = 0;
  Mat4d world_from_mesh;
  std::size_t first_vertex = 0;
  const InstanceTrack* track = nullptr;
  const Deformation* deformation = nullptr;
};

double determinant3(const Mat4d& m) { return dot(m[0].xyz(), cross(m[1].xyz(), m[2].xyz())); }

// Of vectors that transform with the inverse transpose; not unit.
struct NormalTransform {
  Vec3d rows[3];
  explicit NormalTransform(Mat4d m) {
    m[3] = {0, 0, 0, 1};
    const Mat4d inv = inverse(m);
    for (int i = 0; i < 3; ++i) rows[i] = inv[i].xyz();
  }
  Vec3d operator()(Vec3d n) const { return {dot(rows[0], n), dot(rows[1], n), dot(rows[2], n)}; }
};

Changes changes_since(const Frame& now, const Frame* previous) {
  Changes c;
  if (!previous) return c;
  const Geometry &a = now.geometry, &b = previous->geometry;
  c.topology = a.indices != b.indices || a.positions.size() != b.positions.size() ||
               a.triangle_instance != b.triangle_instance || a.instance_albedo != b.instance_albedo;
  c.positions = c.topology || a.positions != b.positions || a.normals != b.normals;
  c.light = now.light != previous->light;
  c.camera = now.camera != previous->camera;
  return c;
}

}  // namespace

struct Scene::Impl {
  SceneFile file;
  std::vector<SceneMesh> meshes;
  std::vector<Placed> placed;
  Geometry first;  // frame 0
  bool geometry_moves = false;
  std::string hash;

  void place_instances();
  void lay_out();
  void write_vertices(const Placed& p, int frame, Geometry& out) const;
  void check_extent() const;
  void check_lights() const;
  void make_hash(const std::string& text);
};

void Scene::Impl::place_instances() {
  std::size_t vertices = 0, triangles = 0;
  for (std::size_t i = 0; i < file.instances.size(); ++i) {
    const InstanceSource& source = file.instances[i];
    const Mesh& mesh = meshes[source.mesh].mesh;
    triangles += mesh.triangle_count() * source.copies();
    vertices += mesh.positions.size() * source.copies();
    if (triangles > UINT32_MAX / 3 || vertices >= UINT32_MAX)
      throw InputError(
          fmt::format("{}: the scene has more than {} triangles.", file.document.name(), UINT32_MAX / 3));
    Placed p;
    p.mesh = source.mesh;
    for (const InstanceTrack& t : file.animation.instances)
      if (t.instance == i) p.track = &t;
    for (const Deformation& d : file.animation.deformations)
      if (d.instance == i) p.deformation = &d;
    geometry_moves |= p.track || p.deformation || !meshes[p.mesh].key_positions.empty();
    const auto offset = [&](int at, int axis) {
      return (at - (source.counts[axis] - 1) / 2.0) * source.spacing[axis];
    };
    for (int z = 0; z < source.counts[2]; ++z)
      for (int y = 0; y < source.counts[1]; ++y)
        for (int x = 0; x < source.counts[0]; ++x) {
          p.instance = first.instance_albedo.size();
          p.world_from_mesh =
              translation({offset(x, 0), offset(y, 1), offset(z, 2)}) * source.world_from_mesh;
          placed.push_back(p);
          first.instance_albedo.push_back(source.albedo);
        }
  }
}

// Topology and frame 0 of the flattened geometry.
void Scene::Impl::lay_out() {
  first.closed = true;
  std::size_t vertices = 0;
  for (Placed& p : placed) {
    const SceneMesh& m = meshes[p.mesh];
    p.first_vertex = vertices;
    vertices += m.mesh.positions.size();
    const bool mirrored = determinant3(p.world_from_mesh) < 0;
    for (std::size_t i = 0; i < m.mesh.indices.size(); ++i) {
      // A mirrored copy would be inside out: its triangles are wound the other way.
      const std::size_t corner = mirrored && i % 3 != 0 ? i - i % 3 + (3 - i % 3) : i;
      first.indices.push_back(static_cast<uint32_t>(p.first_vertex) + m.mesh.indices[corner]);
    }
    first.triangle_instance.insert(first.triangle_instance.end(), m.mesh.triangle_count(),
                                   static_cast<uint32_t>(p.instance));
    first.instance_closed.push_back(m.hygiene.closed());
    first.closed = first.closed && m.hygiene.closed();
  }
  first.positions.resize(vertices);
  first.normals.resize(vertices);
  for (const Placed& p : placed) write_vertices(p, 0, first);
  for (const Vec3f v : first.positions) first.bounds.extend(v);
  check_extent();
}

// Products of larger coordinates leave the range of a float, and Embree ends the program at a ray that has
// them.
void Scene::Impl::check_extent() const {
  for (const Placed& p : placed) {
    const SceneMesh& m = meshes[p.mesh];
    for (std::size_t v = p.first_vertex; v < p.first_vertex + m.mesh.positions.size(); ++v) {
      const Vec3f at = first.positions[v];
      if (std::abs(at.x) <= scene_file::far_away && std::abs(at.y) <= scene_file::far_away &&
          std::abs(at.z) <= scene_file::far_away)
        continue;
      throw InputError(
          fmt::format("{}: a vertex of the mesh '{}' ({}) lies at ({}, {}, {}) in the world, expected "
                      "coordinates from {} to {}.",
                      file.document.name(), m.name, m.origin, at.x, at.y, at.z, -scene_file::far_away,
                      scene_file::far_away));
    }
  }
}

void Scene::Impl::write_vertices(const Placed& p, int frame, Geometry& out) const {
  const SceneMesh& m = meshes[p.mesh];
  const Mat4d world_from_mesh =
      p.track ? p.track->world_from_world(frame) * p.world_from_mesh : p.world_from_mesh;
  const bool identity = world_from_mesh == Mat4d{};
  const NormalTransform to_world(world_from_mesh);
  Timeline::Place key{};
  if (!m.key_positions.empty()) {
    Timeline timeline;
    for (std::size_t k = 0; k <= m.key_positions.size(); ++k)
      timeline.frames.push_back(double(k) * m.frames_per_keyframe);
    timeline.loop = true;
    key = timeline.at(frame);
    key.from %= m.key_positions.size(), key.to %= m.key_positions.size();
  }
  parallel_for(m.mesh.positions.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec3d position(m.mesh.positions[v]), normal(m.mesh.normals[v]);
      if (!m.key_positions.empty()) {
        position = mix(Vec3d(m.key_positions[key.from][v]), Vec3d(m.key_positions[key.to][v]), key.t);
        normal = mix(Vec3d(m.key_normals[key.from][v]), Vec3d(m.key_normals[key.to][v]), key.t);
        if (length(normal) < 1e-6) normal = Vec3d(m.key_normals[key.from][v]);
      }
      if (p.deformation) {
        normal = p.deformation->apply_to_normal(position, normalize(normal), m.bounds, frame);
        position = p.deformation->apply(position, m.bounds, frame);
      }
      out.positions[p.first_vertex + v] =
          Vec3f(identity ? position : transform_point(world_from_mesh, position));
      out.normals[p.first_vertex + v] = Vec3f(normalize(identity ? normal : to_world(normal)));
    }
  });
}

// A light inside a closed mesh lights nothing, which is never meant.
void Scene::Impl::check_lights() const {
  const std::vector<JsonNode> nodes = file.document.root().require("lights", "a scene").items();
  for (std::size_t l = 0; l < file.lights.size(); ++l) {
    const Light& light = file.lights[l];
    if (light.kind == LightKind::directional) continue;
    for (const Placed& p : placed) {
      const SceneMesh& m = meshes[p.mesh];
      const Vec3d local = transform_point(inverse(p.world_from_mesh), Vec3d(light.center));
      const Vec3f at(local);
      const bool near = min(at, m.bounds.hi) == at && max(at, m.bounds.lo) == at;
      if (!near || !m.hygiene.closed() || p.deformation || p.track || winding_number(m.mesh, local) < 0.5)
        continue;
      nodes[l].complain(fmt::format(
          "the light '{}' lies inside the mesh '{}'; move it, or give a room that it lights \"flip\": true.",
          light.name, m.name));
    }
  }
}

void Scene::Impl::make_hash(const std::string& text) {
  Hasher hasher;
  hasher.text("scene").value(generator_version).text(text);
  for (const SceneMesh& m : meshes) {
    hasher.array(std::span(m.mesh.positions))
        .array(std::span(m.mesh.normals))
        .array(std::span(m.mesh.indices));
    for (const auto& key : m.key_positions) hasher.array(std::span(key));
  }
  hash = hasher.hex();
}

Scene::Scene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

Scene Scene::load(const std::string& name_or_path, const std::vector<fs::path>& search) {
  const std::string path = find_scene_file(name_or_path, search);
  auto impl = std::make_unique<Impl>();
  impl->file = parse_scene_file(JsonDocument::read(path));
  const std::vector<fs::path> folders = mesh_folders(path);
  for (const MeshSource& source : impl->file.meshes) impl->meshes.push_back(load_scene_mesh(source, folders));
  impl->place_instances();
  impl->lay_out();
  impl->check_lights();
  impl->make_hash(impl->file.document.json().dump());
  return Scene(std::move(impl));
}

const std::string& Scene::name() const { return impl_->file.name; }
std::vector<std::string> Scene::light_names() const { return impl_->file.light_names(); }
std::vector<std::string> Scene::camera_names() const { return impl_->file.camera_names(); }

namespace {

template <class T>
const T& find_named(const std::vector<T>& list, const std::string& name, const std::string& scene,
                    const char* what) {
  if (name.empty()) return list.front();
  std::vector<std::string> names;
  for (const T& entry : list) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw InputError(fmt::format("scene '{}' has no {} '{}'.{}", scene, what, name, suggestion(name, names)));
}

}  // namespace

const Light& Scene::light(const std::string& name) const {
  return find_named(impl_->file.lights, name, impl_->file.name, "light");
}
const Camera& Scene::camera(const std::string& name) const {
  return find_named(impl_->file.cameras, name, impl_->file.name, "camera");
}

bool Scene::animated() const {
  const Animation& a = impl_->file.animation;
  return impl_->geometry_moves || !a.cameras.empty() || !a.lights.empty();
}

std::string Scene::axis_default(const std::string& axis) const {
  const auto it = impl_->file.axis_defaults.find(axis);
  return it == impl_->file.axis_defaults.end() ? "" : it->second;
}

std::string Scene::content_hash() const { return impl_->hash; }

SceneReport Scene::report() const {
  SceneReport r{
      impl_->file.name, impl_->file.description, impl_->file.fidelity, impl_->first.triangle_count(), {}};
  for (const SceneMesh& m : impl_->meshes) r.meshes.push_back({m.name, m.origin, m.hygiene});
  return r;
}

namespace {

void move_light(Light& light, const LightTrack& track, int frame) {
  const auto [a, b, t] = track.timeline.at(frame);
  const auto s = static_cast<float>(t);
  const Vec3f center = mix(track.center[a], track.center[b], s);
  for (Vec3f& p : light.points) p += center - light.center;
  light.center = center;
  if (track.direction.empty()) return;
  const Vec3f d = normalize(mix(track.direction[a], track.direction[b], s));
  light.direction = d == Vec3f{} ? track.direction[a] : d;
}

void move_camera(Camera& camera, const CameraTrack& track, int frame) {
  const auto [a, b, t] = track.timeline.at(frame);
  camera.eye = mix(track.eye[a], track.eye[b], static_cast<float>(t));
  camera.target = mix(track.target[a], track.target[b], static_cast<float>(t));
}

}  // namespace

Frame Scene::frame(int index, const std::string& light_name, const std::string& camera_name, float light_size,
                   const Frame* previous) const {
  const Impl& impl = *impl_;
  if (index < 0)
    throw InputError(fmt::format("scene '{}': found frame {}, expected at least 0.", name(), index));
  const Light& own_light = light(light_name);
  const Camera& own_camera = camera(camera_name);
  Frame out;
  out.index = index;
  out.geometry = impl.first;
  if (impl.geometry_moves && index > 0) {
    for (const Placed& p : impl.placed)
      if (p.track || p.deformation || !impl.meshes[p.mesh].key_positions.empty())
        impl.write_vertices(p, index, out.geometry);
    out.geometry.bounds = {};
    for (const Vec3f v : out.geometry.positions) out.geometry.bounds.extend(v);
  }
  out.light = own_light;
  for (const LightTrack& t : impl.file.animation.lights)
    if (&impl.file.lights[t.light] == &own_light) move_light(out.light, t, index);
  if (light_size >= 0) out.light = with_size(out.light, light_size);
  out.camera = own_camera;
  for (const CameraTrack& t : impl.file.animation.cameras)
    if (&impl.file.cameras[t.camera] == &own_camera) move_camera(out.camera, t, index);
  out.changes = changes_since(out, previous);
  return out;
}

}  // namespace penumbra
