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

// Area of the projected shadow volumes' bounding rectangles against that of their convex hulls, on C's image
// plane: over at most 20,000 triangles evenly picked; those that reach the camera's plane are left out and
// counted.
void add_area_counters(const Geometry& geometry, const FrameConstants& constants, const Header& header,
                       Counters& counters);

}  // namespace penumbra::gears
