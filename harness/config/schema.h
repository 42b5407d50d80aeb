// JSON Schemas (draft 7), generated: editors check and complete configs with them. The committed copies are
// under configs/schema/; `penumbra describe --schema NAME` prints them.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "technique/technique.h"

namespace penumbra {

struct SchemaFile {
  std::string name;  // "sweep": configs/schema/sweep.schema.json
  nlohmann::json schema;
};
std::vector<SchemaFile> schema_files(const Registry& registry);

// Sweep configs: top-level axes, and for each technique of the registry its parameters.
nlohmann::json sweep_schema(const Registry& registry);

}  // namespace penumbra
