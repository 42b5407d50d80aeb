// Whether the scenes of a plan can be loaded, asked before anything runs: a mesh that is empty or broken, or
// a light inside one, is found when a sweep starts and not hours later, when its scene's turn comes.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "config/plan.h"

namespace penumbra::run {

// Loads each scene of the points once, in a process of its own: a mesh reader that crashes on a damaged file
// is an answer too, and no memory stays taken. Throws InputError with the scene's own message (all of them,
// one a line). Returns what a user should know of scenes that are good: triangles that were left out because
// a corner was not finite or an index out of range. `cache`: folder in which the answer is kept by the
// contents of scene and mesh files, so that large meshes are read twice only the first time; empty: no cache.
std::vector<std::string> check_scenes(const std::vector<Point>& points,
                                      const std::vector<std::filesystem::path>& search,
                                      const std::filesystem::path& cache);

}  // namespace penumbra::run
