// Finer meshes out of coarse ones: Loop subdivision, and edges split until a mesh has a given triangle count.
#pragma once
#include <cstddef>
#include <string>

#include "scene/mesh.h"

namespace penumbra {

struct Subdivision {
  int loop = 0;                      // steps of Loop subdivision, 0 to 6; each makes four triangles of one
  std::size_t target_triangles = 0;  // then edges are split until there are as many; 0: none are
  bool any() const { return loop > 0 || target_triangles > 0; }
};

// One step of Loop subdivision [Loop1987] over vertices welded by position. Edges with one face, or with more
// than two, stay creases: their curve is subdivided by itself (1/8, 6/8, 1/8). A vertex where other than two
// creases meet stays where it is. Winding is that of the triangle each one comes from.
// The result shares vertices and has no normals; `mesh` must be clean().
Mesh loop_subdivided(const Mesh& mesh);

// Splits the longest edge at its middle, again and again, until there are `target` triangles: a split adds
// one triangle for each face of the edge, and moves the surface by no more than rounding. The longest edge is
// one with two faces; where a single triangle is missing, one with one face. No normals in the result. Throws
// InputError naming `place` where `target` is less than there are, or cannot be met exactly.
Mesh split_to(const Mesh& mesh, std::size_t target, const std::string& place);

// Both, in that order. Throws InputError naming `place`, as split_to() does, and for more than 2^28
// triangles.
Mesh subdivided(const Mesh& mesh, const Subdivision& how, const std::string& place);

}  // namespace penumbra
