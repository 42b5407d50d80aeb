// What the scene loader needs beyond clean(): which vertices survived, and normals made anew.
#pragma once
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace penumbra {

struct CleanResult {
  MeshHygiene hygiene;
  std::vector<uint32_t> kept_vertices;  // old vertex number of each vertex that is left
};
// clean(), telling which vertices are left: keyframes of the same mesh are cut down the same way.
CleanResult clean_tracked(Mesh& mesh, const std::string& origin);

// Area-weighted normals over welded vertices, one per mesh vertex, unit.
std::vector<Vec3f> smooth_normals(const Mesh& mesh, const Adjacency& adjacency);

}  // namespace penumbra
