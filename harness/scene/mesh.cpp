#include "scene/mesh.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "scene/mesh_repair.h"

namespace penumbra {
namespace {

bool finite(Vec3f v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// In double precision, where differences and products of floats of like magnitude are exact: zero means zero.
bool has_area(Vec3f a, Vec3f b, Vec3f c) {
  const Vec3d n = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
  return n.x != 0 || n.y != 0 || n.z != 0;
}

void drop_bad_triangles(Mesh& mesh, MeshHygiene& hygiene) {
  hygiene.triangles_in = mesh.triangle_count();
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const std::size_t n = mesh.positions.size();
    if (a >= n || b >= n || c >= n) {
      ++hygiene.dropped_index;
      continue;
    }
    const Vec3f pa = mesh.positions[a], pb = mesh.positions[b], pc = mesh.positions[c];
    if (!finite(pa) || !finite(pb) || !finite(pc)) {
      ++hygiene.dropped_not_finite;
      continue;
    }
    if (!has_area(pa, pb, pc)) {
      ++hygiene.dropped_degenerate;
      continue;
    }
    mesh.indices[kept] = a, mesh.indices[kept + 1] = b, mesh.indices[kept + 2] = c;
    kept += 3;
  }
  mesh.indices.resize(kept);
}

// Removes vertices that no triangle uses (some may not be finite); returns the old number of each one kept.
std::vector<uint32_t> drop_unused_vertices(Mesh& mesh) {
  std::vector<uint32_t> number(mesh.positions.size(), 0);
  for (const uint32_t i : mesh.indices) number[i] = 1;
  std::vector<uint32_t> kept;
  const bool with_normals = mesh.normals.size() == mesh.positions.size();
  for (uint32_t v = 0; v < number.size(); ++v) {
    if (!number[v]) continue;
    number[v] = static_cast<uint32_t>(kept.size());
    mesh.positions[kept.size()] = mesh.positions[v];
    if (with_normals) mesh.normals[kept.size()] = mesh.normals[v];
    kept.push_back(v);
  }
  mesh.positions.resize(kept.size());
  if (with_normals) mesh.normals.resize(kept.size());
  for (uint32_t& i : mesh.indices) i = number[i];
  return kept;
}

void count_edges(const Adjacency& adjacency, MeshHygiene& hygiene) {
  for (const Edge& e : adjacency.edges) {
    if (e.face_count == 1) ++hygiene.open_edges;
    if (e.face_count > 2) ++hygiene.non_manifold_edges;
    if (e.face_count == 2 && adjacency.faces[e.first_face].sign == adjacency.faces[e.first_face + 1].sign)
      ++hygiene.inconsistent_edges;
  }
}

// Replaces missing normals, and single ones that are not finite or zero.
void fill_normals(Mesh& mesh, const Adjacency& adjacency) {
  const bool missing = mesh.normals.size() != mesh.positions.size();
  bool any_bad = missing;
  if (!missing)
    for (Vec3f& n : mesh.normals) {
      n = Vec3f(normalize(Vec3d(n)));
      any_bad |= !finite(n) || n == Vec3f{};
    }
  if (!any_bad) return;
  const std::vector<Vec3f> smooth = smooth_normals(mesh, adjacency);
  if (missing) mesh.normals = smooth;
  for (std::size_t v = 0; v < mesh.normals.size(); ++v)
    if (!finite(mesh.normals[v]) || mesh.normals[v] == Vec3f{}) mesh.normals[v] = smooth[v];
}

}  // namespace

std::vector<Vec3f> smooth_normals(const Mesh& mesh, const Adjacency& adjacency) {
  std::vector<Vec3d> sums(adjacency.representative.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t* v = &mesh.indices[i];
    const Vec3d a(mesh.positions[v[0]]), b(mesh.positions[v[1]]), c(mesh.positions[v[2]]);
    const Vec3d n = cross(b - a, c - a);
    for (int k = 0; k < 3; ++k) sums[adjacency.welded[v[k]]] += n;
  }
  std::vector<Vec3f> normals(mesh.positions.size());
  for (std::size_t v = 0; v < normals.size(); ++v) {
    // Faces that cancel out exactly leave no direction; any unit vector keeps what follows free of NaN.
    const Vec3f n(normalize(sums[adjacency.welded[v]]));
    normals[v] = n == Vec3f{} ? Vec3f{0, 1, 0} : n;
  }
  return normals;
}

CleanResult clean_tracked(Mesh& mesh, const std::string& origin) {
  CleanResult result;
  MeshHygiene& hygiene = result.hygiene;
  drop_bad_triangles(mesh, hygiene);
  if (mesh.indices.empty())
    throw InputError(
        fmt::format("{}: no triangle is left: {} read, {} with an index out of range, {} with a corner that "
                    "is not finite, {} without "
                    "area",
                    origin, hygiene.triangles_in, hygiene.dropped_index, hygiene.dropped_not_finite,
                    hygiene.dropped_degenerate));
  result.kept_vertices = drop_unused_vertices(mesh);
  const Adjacency adjacency = build_adjacency(mesh.positions, mesh.indices);
  hygiene.duplicate_vertices = mesh.positions.size() - adjacency.representative.size();
  count_edges(adjacency, hygiene);
  fill_normals(mesh, adjacency);
  return result;
}

MeshHygiene clean(Mesh& mesh, const std::string& origin) { return clean_tracked(mesh, origin).hygiene; }

}  // namespace penumbra
