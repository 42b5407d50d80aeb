// JSON Schema (draft 7) of scene files, from the same lists that the parser checks against where there are
// such.
#pragma once
#include <nlohmann/json.hpp>

namespace penumbra {

nlohmann::json scene_schema();

}  // namespace penumbra
