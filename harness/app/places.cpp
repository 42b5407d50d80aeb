// Where configs, scenes and scripts are, from whatever folder the program is started.
#include <fmt/format.h>

#include <algorithm>

#include "app/commands.h"
#include "core/error.h"

namespace penumbra {
namespace fs = std::filesystem;
namespace {

// All sweeps and scenes below `folder`, as names relative to it without the extension.
void collect(const fs::path& folder, std::vector<std::string>& names,
             const std::vector<std::string>& left_out) {
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it.depth() == 0 && it->is_directory() &&
        std::ranges::find(left_out, it->path().filename().string()) != left_out.end())
      it.disable_recursion_pending();
    else if (it->is_regular_file() && it->path().extension() == ".json" &&
             it->path().filename() != "paper.json")  // what scripts/reproduce reads beside its configs
      names.push_back(it->path().lexically_relative(folder).replace_extension().generic_string());
  }
}

std::vector<std::string> sorted_unique(std::vector<std::string> names) {
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

void find_roots(Context& context, const char* argv0) {
  std::error_code error;
  fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) program = fs::absolute(argv0, error);
  for (const fs::path& folder : {fs::current_path(error), fs::path(PENUMBRA_SOURCE_DIR),
                                 program.parent_path(), program.parent_path().parent_path()}) {
    if (!fs::is_directory(folder / "configs", error)) continue;
    const fs::path root = fs::canonical(folder, error);
    if (error || std::ranges::find(context.roots, root) != context.roots.end()) continue;
    context.roots.push_back(root);
    if (fs::is_directory(root / "configs/scenes", error))
      context.scene_search.push_back(root / "configs/scenes");
  }
}

fs::path Context::find_config(const std::string& name) const {
  std::error_code error;
  if (fs::is_regular_file(name, error)) return name;
  for (const fs::path& root : roots)
    for (const fs::path& candidate :
         {root / name, root / "configs" / name, root / "configs" / (name + ".json")})
      if (fs::is_regular_file(candidate, error)) return candidate;
  std::vector<std::string> names = config_names();
  throw InputError(
      fmt::format("{}: no such config file.{}", name, suggestion(fs::path(name).replace_extension(), names)));
}

fs::path Context::find_file(const std::string& relative) const {
  std::error_code error;
  for (const fs::path& root : roots)
    if (fs::exists(root / relative, error)) return root / relative;
  throw InputError(fmt::format("{}: not found beside any of the folders that have configs/.", relative));
}

std::vector<std::string> Context::config_names() const {
  std::vector<std::string> names;
  for (const fs::path& root : roots) collect(root / "configs", names, {"scenes", "schema"});
  return sorted_unique(names);
}

std::vector<std::string> Context::scene_names() const {
  std::vector<std::string> names;
  for (const fs::path& folder : scene_search) collect(folder, names, {"meshes"});
  return sorted_unique(names);
}

}  // namespace penumbra
