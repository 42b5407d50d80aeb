// Indexed triangle meshes, and what is wrong with them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"

namespace penumbra {

// Counts of what a mesh file or generator contained. Repairs change the mesh: triangles with an out-of-range
// index or a vertex that is not finite are dropped, and so are degenerate ones (two equal corners by index or
// position, or exactly zero area). Everything else is only counted.
struct MeshHygiene {
  std::size_t triangles_in = 0;        // as read, after triangulation
  std::size_t dropped_index = 0;       // index out of range
  std::size_t dropped_not_finite = 0;  // NaN or infinity in a corner
  std::size_t dropped_degenerate = 0;  // no area
  std::size_t duplicate_vertices = 0;  // same position as an earlier vertex
  std::size_t open_edges = 0;          // edges with one face, after welding by exact position
  std::size_t non_manifold_edges = 0;  // edges with more than two faces
  std::size_t inconsistent_edges = 0;  // edges with two faces that traverse them in the same direction
  bool closed() const { return open_edges == 0 && non_manifold_edges == 0 && inconsistent_edges == 0; }
  bool operator==(const MeshHygiene&) const = default;
};

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;     // per vertex, unit; never empty after clean()
  std::vector<uint32_t> indices;  // 3 per triangle, counter-clockwise seen from outside
  std::size_t triangle_count() const { return indices.size() / 3; }
};

// Drops what MeshHygiene says is dropped, fills missing normals (area-weighted), counts the rest.
// Throws InputError naming `origin` when no triangle is left.
MeshHygiene clean(Mesh& mesh, const std::string& origin);

// Half-edge adjacency after welding vertices by exact position. `winding` techniques need it.
struct Edge {
  uint32_t vertex[2];   // welded vertex ids, vertex[0] < vertex[1]
  uint32_t first_face;  // faces of this edge are faces[first_face .. first_face + face_count)
  uint32_t face_count;
};
struct EdgeFace {
  uint32_t triangle;
  int8_t sign;  // +1: the triangle runs vertex[0] -> vertex[1]; -1: the other way
};
struct Adjacency {
  std::vector<uint32_t> welded;          // mesh vertex -> welded vertex
  std::vector<uint32_t> representative;  // welded vertex -> one mesh vertex that has its position
  std::vector<Edge> edges;
  std::vector<EdgeFace> faces;
};
// Positions: any array of vertices; indices: 3 per triangle. Parallel; O(n log n).
Adjacency build_adjacency(const std::vector<Vec3f>& positions, const std::vector<uint32_t>& indices);

}  // namespace penumbra
