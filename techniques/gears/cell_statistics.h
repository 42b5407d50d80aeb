// What the paper reports of its grid [GEARS, tables 5 and 6, figures 9 and 10], from the counts of a frame.
#pragma once
#include <vector>

#include "scene/scene.h"
#include "technique/technique.h"
#include "techniques/gears/shaders/shared.h"

namespace penumbra::gears {

struct CellCounts {
  std::vector<uint32_t> samples, triangles;  // per cell, the one for what has no place on the grid last
};

// Averages and maxima over all cells of the grid, the total of assigned pairs, and the heat map of view
// samples.
void add_cell_counters(const CellCounts& counts, Counters& counters);

// The shadow volume of one triangle on C's image plane, in cells of the grid: the bounding rectangle that is
// assigned, and the convex hull that would do.
struct ProjectedVolume {
  std::vector<Vec2d> rectangle, hull;
};
// Of at most `most` triangles, evenly picked among those whose volume lies before C and touches the grid of
// `grid_size` x `grid_size` cells.
std::vector<ProjectedVolume> projected_volumes(const Geometry& geometry, const FrameConstants& constants,
                                               const Header& header, uint32_t grid_size, std::size_t most);

// Area of the projected shadow volumes' bounding rectangles against that of their convex hulls, on C's image
// plane: over at most 20,000 triangles evenly picked; those that reach the camera's plane are left out and
// counted.
void add_area_counters(const Geometry& geometry, const FrameConstants& constants, const Header& header,
                       Counters& counters);

}  // namespace penumbra::gears
