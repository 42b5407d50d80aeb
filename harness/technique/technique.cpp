#include "technique/technique.h"

#include <fmt/format.h>

namespace penumbra {

const TechniqueInfo& find_technique(const Registry& registry, const std::string& name) {
  std::vector<std::string> names;
  for (const TechniqueInfo& info : registry) {
    if (info.name == name) return info;
    names.push_back(info.name);
  }
  throw InputError(fmt::format("unknown technique '{}'.{}", name, suggestion(name, names)));
}

}  // namespace penumbra
