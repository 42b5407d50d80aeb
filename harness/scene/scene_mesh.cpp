#include "scene/scene_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "scene/mesh_file.h"
#include "scene/mesh_repair.h"
#include "scene/mesh_search.h"

namespace penumbra {
namespace {

Box bounds_of(const std::vector<Vec3f>& positions) {
  Box box;
  for (const Vec3f p : positions) box.extend(p);
  return box;
}

struct FitTransform {
  double scale = 1;
  Vec3d origin, offset;
  Vec3f apply(Vec3f p) const { return Vec3f((Vec3d(p) - origin) * scale + offset); }
};

// See Fit. In double precision, rounded once.
FitTransform fit_transform(const Box& box, const Fit& fit, const std::string& place) {
  const Vec3d lo(box.lo), hi(box.hi), extent = hi - lo;
  const double longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0)) throw InputError(place + ": a mesh without extent cannot be fitted to a size.");
  return {fit.size / longest, {(lo.x + hi.x) / 2, lo.y, (lo.z + hi.z) / 2}, {0, fit.ground, 0}};
}

std::filesystem::path locate(const MeshSource& source, const std::vector<std::filesystem::path>& folders) {
  std::filesystem::path path = find_mesh(source.file, folders);
  if (path.empty())
    throw InputError(fmt::format("{}: the mesh file '{}' is not found.{}", source.place, source.file,
                                 how_to_get(source.file, folders)));
  return path;
}

Mesh read_or_generate(const MeshSource& source, const std::filesystem::path& path) {
  try {
    return path.empty() ? generate(source.generator, source.arguments)
                        : load_mesh(path, source.first_keyframe);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", source.place, e.what()));
  }
}

void flip_triangles(Mesh& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  for (Vec3f& n : mesh.normals) n = -n;
}

// Keyframe k of the file, cut down to the vertices that the first one kept.
void add_keyframe(SceneMesh& out, const MeshSource& source, const std::filesystem::path& path, int k,
                  std::size_t vertices_in_file, const std::vector<uint32_t>& kept, const FitTransform* fit) {
  const Mesh raw = load_mesh(path, source.first_keyframe + k);
  if (raw.positions.size() != vertices_in_file)
    throw InputError(fmt::format("{}: keyframe {} of '{}' has {} vertices, the first has {}.", source.place,
                                 source.first_keyframe + k, source.file, raw.positions.size(),
                                 vertices_in_file));
  Mesh key;
  key.indices = out.mesh.indices;
  for (const uint32_t v : kept)
    key.positions.push_back(fit ? fit->apply(raw.positions[v]) : raw.positions[v]);
  for (const Vec3f p : key.positions)
    if (!std::isfinite(p.x + p.y + p.z))
      throw InputError(fmt::format("{}: keyframe {} of '{}' has a vertex that is not finite.", source.place,
                                   source.first_keyframe + k, source.file));
  key.normals = smooth_normals(key, build_adjacency(out.mesh.positions, out.mesh.indices));
  out.key_positions.push_back(std::move(key.positions));
  out.key_normals.push_back(std::move(key.normals));
}

// What was dropped is told of the source, the edges of what is drawn.
void subdivide(SceneMesh& out, const MeshSource& source) {
  out.mesh = subdivided(out.mesh, source.subdivide, source.place);
  MeshHygiene fine = clean(out.mesh, source.place + ": " + out.origin + ", subdivided");
  fine.triangles_in = out.hygiene.triangles_in;
  fine.dropped_index = out.hygiene.dropped_index;
  fine.dropped_not_finite = out.hygiene.dropped_not_finite;
  fine.dropped_degenerate += out.hygiene.dropped_degenerate;
  out.hygiene = fine;
}

}  // namespace

SceneMesh load_scene_mesh(const MeshSource& source, const std::vector<std::filesystem::path>& folders) {
  SceneMesh out;
  out.name = source.name;
  const std::filesystem::path path = source.file.empty() ? std::filesystem::path{} : locate(source, folders);
  out.origin = path.empty() ? source.generator : path.string();
  out.mesh = read_or_generate(source, path);
  const std::size_t vertices_in_file = out.mesh.positions.size();
  const CleanResult cleaned = clean_tracked(out.mesh, source.place + ": " + out.origin);
  out.hygiene = cleaned.hygiene;
  if (source.subdivide.any()) subdivide(out, source);

  FitTransform fit;
  if (source.fit) {
    fit = fit_transform(bounds_of(out.mesh.positions), *source.fit, source.place);
    for (Vec3f& p : out.mesh.positions) p = fit.apply(p);
  }
  const bool moves = source.keyframes > 1;
  if (source.flip) flip_triangles(out.mesh);
  if (source.recompute_normals || moves)
    out.mesh.normals = smooth_normals(out.mesh, build_adjacency(out.mesh.positions, out.mesh.indices));
  out.bounds = bounds_of(out.mesh.positions);
  if (moves) {
    out.frames_per_keyframe = source.frames_per_keyframe;
    out.key_positions.push_back(out.mesh.positions);
    out.key_normals.push_back(out.mesh.normals);
    for (int k = 1; k < source.keyframes; ++k)
      add_keyframe(out, source, path, k, vertices_in_file, cleaned.kept_vertices,
                   source.fit ? &fit : nullptr);
  }
  return out;
}

double winding_number(const Mesh& mesh, Vec3d p) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3d a = Vec3d(mesh.positions[mesh.indices[i]]) - p,
                b = Vec3d(mesh.positions[mesh.indices[i + 1]]) - p,
                c = Vec3d(mesh.positions[mesh.indices[i + 2]]) - p;
    const double la = length(a), lb = length(b), lc = length(c);
    // Van Oosterom and Strackee's solid angle of a triangle, halved.
    sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace penumbra
