#include "scene/generators.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "scene/generator_table.h"

namespace penumbra {
namespace {

const std::vector<Generator>& table() {
  static const std::vector<Generator> all = [] {
    std::vector<Generator> list = shape_generators();
    for (const auto& more :
         {natural_generators(), std::vector<Generator>{church_generator(), atrium_generator()},
          study_generators()})
      list.insert(list.end(), more.begin(), more.end());
    return list;
  }();
  return all;
}

const Generator& find_generator(const std::string& name) {
  std::vector<std::string> names;
  for (const Generator& g : table()) {
    if (g.info.name == name) return g;
    names.push_back(g.info.name);
  }
  throw InputError(fmt::format("unknown generator '{}'.{}", name, suggestion(name, names)));
}

void check_range(const std::string& generator, const GeneratorInfo::Param& p, double v) {
  if (!(v >= p.lo && v <= p.hi) || (p.integer && v != std::floor(v)))
    throw InputError(fmt::format("generator '{}': found {} = {}, expected {} from {} to {}", generator,
                                 p.name, v, p.integer ? "an integer" : "a number", p.lo, p.hi));
}

}  // namespace

const std::vector<GeneratorInfo>& generators() {
  static const std::vector<GeneratorInfo> infos = [] {
    std::vector<GeneratorInfo> list;
    for (const Generator& g : table()) list.push_back(g.info);
    return list;
  }();
  return infos;
}

namespace {

// Given values over defaults, all checked.
std::map<std::string, double> checked_values(const Generator& g,
                                             const std::vector<GeneratorArgument>& arguments) {
  std::map<std::string, double> values;
  std::vector<std::string> names;
  for (const GeneratorInfo::Param& p : g.info.params) values[p.name] = p.fallback, names.push_back(p.name);
  for (const GeneratorArgument& a : arguments) {
    if (!values.contains(a.name))
      throw InputError(fmt::format("generator '{}' has no parameter '{}'.{}", g.info.name, a.name,
                                   suggestion(a.name, names)));
    values[a.name] = a.value;
  }
  for (const GeneratorInfo::Param& p : g.info.params) check_range(g.info.name, p, values[p.name]);
  return values;
}

}  // namespace

void check_arguments(const std::string& generator, const std::vector<GeneratorArgument>& arguments) {
  (void)checked_values(find_generator(generator), arguments);
}

Mesh generate(const std::string& generator, const std::vector<GeneratorArgument>& arguments) {
  const Generator& g = find_generator(generator);
  return g.make(GeneratorValues(checked_values(g, arguments)));
}

}  // namespace penumbra
