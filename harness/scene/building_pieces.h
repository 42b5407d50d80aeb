// Closed pieces of buildings: what the church and the atrium are put together from. All append to `out`, wind
// counter-clockwise seen from outside and state their triangle count. Pieces may lie within one another; none
// shares an edge with another as long as they are not placed so that two edges are the same.
#pragma once
#include <functional>
#include <vector>

#include "core/vec.h"
#include "scene/mesh.h"

namespace penumbra {

struct ProfilePoint {
  double radius, height;  // radius > 0; heights may fall where the profile turns inwards
};
// Solid of revolution about the vertical through `foot`, from the lowest point up: 2 sides triangles a point.
void add_lathe(Mesh& out, Vec3d foot, const std::vector<ProfilePoint>& profile, int sides);

// The solid between two sheets of (columns + 1) x (rows + 1) points, `front` facing cross(along i, along j):
// 4 columns rows + 4 (columns + rows). Cells are cut from (i, j) to (i + 1, j + 1), or the other way where
// `turned(i, j)`.
using SheetPoint = std::function<Vec3d(int i, int j)>;
void add_slab(Mesh& out, int columns, int rows, const SheetPoint& front, const SheetPoint& back,
              const std::function<bool(int, int)>& turned = {});

// An arch from -1 to 1, of height 1: two circular arcs whose radius is `pointed` (at least 1: a half circle)
// in half widths. stops: segments + 1 places (segments even), spaced evenly along the arcs, exactly -1, 0 and
// 1 among them.
double arch_height(double at, double pointed);
std::vector<double> arch_stops(int segments, double pointed);

struct Arch {
  double half_width = 1, springing = 0, rise = 1, pointed = 1;
  int segments = 16;  // even
};
// Points along the arch in the vertical plane through `foot` along the unit vector `along`.
std::vector<Vec3d> arch_line(const Arch& arch, Vec3d foot, Vec3d along);
// A curved bar of rectangular section below which the arch is open: 8 segments + 4.
void add_arch_bar(Mesh& out, const Arch& arch, Vec3d foot, Vec3d along, double depth, double thickness);

// A straight wall with one arched opening a bay, its middle at `foot`, `along` a unit vector.
struct ArcadeWall {
  Vec3d foot, along;
  int bays = 1;
  double bay = 1, thickness = 0.5, top = 2;
  double sill = 0;    // above the foot; 0: openings reach the floor, and nothing is built below the springing
  double beyond = 0;  // the wall reaches past the outer bays by this
  Arch arch;
};
// 8 (bays segments + bays + 1) + 4; with a sill 12 (bays + 2) more: the wall below, and what stands between.
void add_arcade_wall(Mesh& out, const ArcadeWall& wall);

// A groined vault over a rectangle about `center`, which is at the springing: 4 n^2 + 8 n with n segments.
// Both barrels have the arch's height; its half_width is not used.
struct Vault {
  Vec3d center;
  double half_x = 1, half_z = 1, thickness = 0.2;
  Arch arch;
};
void add_vault(Mesh& out, const Vault& vault);
// The ribs below its groins, two tubes: 2 (2 sides n + 2 (sides - 2)).
void add_vault_ribs(Mesh& out, const Vault& vault, double radius, int sides);

}  // namespace penumbra
