// A mesh of a scene, ready to be placed.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scene/mesh.h"
#include "scene/scene_file.h"

namespace penumbra {

struct SceneMesh {
  std::string name, origin;  // origin: the file, or the generator's name
  Mesh mesh;                 // clean, fitted; positions of the first keyframe
  MeshHygiene hygiene;
  Box bounds;
  // Of meshes with keyframes, the first included; empty for others. Same vertices and triangles as `mesh`.
  std::vector<std::vector<Vec3f>> key_positions, key_normals;
  double frames_per_keyframe = 1;
};

// Throws InputError; a file that is not found says which command gets it.
SceneMesh load_scene_mesh(const MeshSource& source, const std::vector<std::filesystem::path>& folders);

// How often a closed mesh winds about p: 1 inside, 0 outside (by the solid angles of its triangles).
double winding_number(const Mesh& mesh, Vec3d p);

}  // namespace penumbra
