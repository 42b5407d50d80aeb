#include "scene/mesh_search.h"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#include "core/error.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

struct Source {
  const char* file;
  const char* command;
};
constexpr Source sources[] = {
    {"bunny.obj", "apt-get install glmark2-data"},
    {"bunny.bin.stl", "scripts/fetch_scenes bunny_original"},
    {"dragon_vrip.ply.gz", "scripts/fetch_scenes dragon"},
    {"dragon_vrip_res2.ply.gz", "scripts/fetch_scenes dragon"},
    {"dragon_vrip_res3.ply.gz", "scripts/fetch_scenes dragon"},
    {"dragon_vrip_res4.ply.gz", "scripts/fetch_scenes dragon"},
    {"cow.off", "scripts/fetch_scenes cgal"},
    {"armadillo.off", "scripts/fetch_scenes cgal"},
    {"refined_elephant.off", "scripts/fetch_scenes cgal"},
    {"spider.obj", "scripts/fetch_scenes assimp"},
    {"faerie.md2", "scripts/fetch_scenes assimp"},
    {"sydney.md2", "scripts/fetch_scenes assimp"},
    {"chess/king.obj", "scripts/fetch_scenes chess"},
    {"chess/queen.obj", "scripts/fetch_scenes chess"},
    {"chess/rook.obj", "scripts/fetch_scenes chess"},
    {"chess/bishop.obj", "scripts/fetch_scenes chess"},
    {"chess/knight.obj", "scripts/fetch_scenes chess"},
    {"chess/pawn.obj", "scripts/fetch_scenes chess"},
};

}  // namespace

std::vector<fs::path> mesh_folders(const fs::path& scene_file) {
  std::vector<fs::path> folders;
  const auto add = [&](const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return;
    for (const fs::path& known : folders)
      if (fs::equivalent(known, folder, error)) return;
    folders.push_back(folder);
  };
  std::error_code error;
  fs::path folder = fs::absolute(scene_file, error).parent_path();
  add(folder);
  for (;; folder = folder.parent_path()) {
    add(folder / "meshes");
    if (!folder.has_relative_path()) break;
  }
  add(fs::path("meshes"));
  if (const char* list = std::getenv("PENUMBRA_MESHES")) {
    std::istringstream in(list);
    for (std::string entry; std::getline(in, entry, ':');)
      if (!entry.empty()) add(entry);
  }
  for (const char* known :
       {"/usr/share/glmark2/models", "/usr/share/assimp/models", "/usr/local/share/glmark2/models"})
    add(known);
  return folders;
}

fs::path find_mesh(const std::string& file, const std::vector<fs::path>& folders) {
  std::error_code error;
  if (fs::path(file).is_absolute()) return fs::is_regular_file(file, error) ? fs::path(file) : fs::path{};
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / file, error)) return folder / file;
  return {};
}

std::string how_to_get(const std::string& file, const std::vector<fs::path>& folders) {
  for (const Source& s : sources)
    if (file == s.file) return fmt::format(" Get it with: {}", s.command);
  std::vector<std::string> names;
  for (const Source& s : sources) names.emplace_back(s.file);
  std::error_code error;
  for (const fs::path& folder : folders)
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.is_regular_file(error)) names.push_back(entry.path().filename().string());
  const std::string near = nearest_name(file, names);
  std::string hint = near.empty() ? "" : fmt::format(" Did you mean '{}'?", near);
  hint += " Looked in:";
  for (const fs::path& folder : folders) hint += " " + folder.string();
  return hint;
}

}  // namespace penumbra
