// What a scene holds, for people and for scripts: `penumbra describe --scene`.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "app/commands.h"
#include "scene/scene.h"

namespace penumbra {

// name, description, fidelity, triangles, animated, bounds (lowest and highest corner, frame 0),
// content_hash, and lists of meshes (origin: a file's name or a generator's; what loading dropped; edges that
// keep it from being closed), lights and cameras (world space, scene units, degrees).
nlohmann::json scene_description(const Scene& scene);
// Prints it. Throws InputError as Scene::load() does.
void describe_scene(const Context& context, const std::string& name, bool as_json);

}  // namespace penumbra
