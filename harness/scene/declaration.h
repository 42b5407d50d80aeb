// What a scene file declares, read and checked without loading or generating a mesh: enough to expand a sweep
// and to refuse a wrong one before anything runs.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene/light.h"

namespace penumbra {

struct SceneDeclaration {
  std::string name, description, fidelity;
  std::filesystem::path file;
  std::vector<Light> lights;                         // the first is the default
  std::vector<std::string> cameras;                  // the first is the default
  std::map<std::string, std::string> axis_defaults;  // axis -> JSON text
};

// A name under one of the folders `search`, or a path. Throws InputError with the nearest name.
std::string find_scene_file(const std::string& name_or_path,
                            const std::vector<std::filesystem::path>& search);

// Name or path, found as Scene::load() finds it. Throws InputError for everything that is wrong with the file
// itself and for mesh files that are missing (with the command that gets them).
SceneDeclaration declare_scene(const std::string& name_or_path,
                               const std::vector<std::filesystem::path>& search);

}  // namespace penumbra
