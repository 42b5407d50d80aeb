#include "scene/declaration.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "scene/generators.h"
#include "scene/mesh_search.h"
#include "scene/scene_file.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

void check_mesh(const MeshSource& source, const std::vector<fs::path>& folders) {
  if (!source.file.empty()) {
    if (find_mesh(source.file, folders).empty())
      throw InputError(fmt::format("{}: the mesh file '{}' is not found.{}", source.place, source.file,
                                   how_to_get(source.file, folders)));
    return;
  }
  try {
    check_arguments(source.generator, source.arguments);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", source.place, e.what()));
  }
}

}  // namespace

std::string find_scene_file(const std::string& name_or_path, const std::vector<fs::path>& search) {
  std::error_code error;
  if (name_or_path.ends_with(".json") || name_or_path.find('/') != std::string::npos) {
    if (fs::is_regular_file(name_or_path, error)) return name_or_path;
    throw InputError(fmt::format("{}: no such scene file.", name_or_path));
  }
  std::vector<std::string> names;
  for (const fs::path& folder : search) {
    const fs::path path = folder / (name_or_path + ".json");
    if (fs::is_regular_file(path, error)) return path.string();
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  throw InputError(fmt::format("unknown scene '{}'.{}", name_or_path, suggestion(name_or_path, names)));
}

SceneDeclaration declare_scene(const std::string& name_or_path, const std::vector<fs::path>& search) {
  const fs::path path = find_scene_file(name_or_path, search);
  const SceneFile file = parse_scene_file(JsonDocument::read(path));
  const std::vector<fs::path> folders = mesh_folders(path);
  for (const MeshSource& source : file.meshes) check_mesh(source, folders);
  return {file.name,   file.description,    file.fidelity,     path,
          file.lights, file.camera_names(), file.axis_defaults};
}

}  // namespace penumbra
