// Where mesh files are looked for.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra {

// In this order: the scene file's folder, `meshes/` in it and in the folders above it, `meshes/` in the
// current folder, the folders in the environment variable PENUMBRA_MESHES (separated by ':'), folders of
// packages that bring meshes.
std::vector<std::filesystem::path> mesh_folders(const std::filesystem::path& scene_file);

// The file, or an empty path.
std::filesystem::path find_mesh(const std::string& file, const std::vector<std::filesystem::path>& folders);

// The end of an error message: which command gets the file, or what it may have meant.
std::string how_to_get(const std::string& file, const std::vector<std::filesystem::path>& folders);

}  // namespace penumbra
