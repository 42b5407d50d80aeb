// View samples put into groups of neighbours: tiles of the picture, each cut again and again across its
// longest side.
#pragma once
#include <cstddef>
#include <vector>

#include "techniques/depth_complexity_sampling/judge.h"

namespace penumbra::depth_complexity {

inline constexpr int tile_side = 32;
inline constexpr std::size_t tile_pixels = tile_side * tile_side;

std::size_t tile_count(const ViewSamplesHost& view);

// The view samples of a tile that the light can reach, in an order in which runs of `small_group`,
// `middle_group` and `large_group` are neighbours in space. The other pixels' outputs are written; those of
// view samples in the light's very plane by a ray per light sample. `out` has
// room for tile_pixels.
std::size_t gather_tile(const ViewSamplesHost& view, std::size_t tile, const LightSpace& light,
                        const RayJudge& judge, ViewPoint* out, WorkCounts& counts);

}  // namespace penumbra::depth_complexity
