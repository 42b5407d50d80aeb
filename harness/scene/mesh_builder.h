// Pieces that the generators put together. All append to `out` and wind counter-clockwise seen from outside.
#pragma once
#include <vector>

#include "core/vec.h"
#include "scene/mesh.h"

namespace penumbra {

uint32_t add_vertex(Mesh& out, Vec3d position, Vec3d unit_normal);
void add_triangle(Mesh& out, uint32_t a, uint32_t b, uint32_t c);

// The parallelogram corner + s u + t v, columns x rows quads of two triangles, facing cross(u, v).
void add_sheet(Mesh& out, Vec3d corner, Vec3d u, Vec3d v, int columns, int rows);
// 12 triangles with face normals; vertices are not shared between faces.
void add_box(Mesh& out, Vec3d lo, Vec3d hi);
// 2 columns (rows - 1) triangles: `rows` bands from pole to pole along y, scaled by `radii`.
void add_ellipsoid(Mesh& out, Vec3d center, Vec3d radii, int columns, int rows);

enum class TubeEnds { joined, open, capped };
// A tube of `sides` sides about a polyline: 2 sides triangles for each segment, and 2 (sides - 2) for caps.
// The frame starts from `up` and is carried along the line by projection. A joined tube closes on its first
// point.
void add_tube(Mesh& out, const std::vector<Vec3d>& line, double radius, int sides, TubeEnds ends,
              Vec3d up = {0.3, 0.9, 0.2});

}  // namespace penumbra
