#include "tests/fuzz/registry.h"

namespace penumbra::test {
namespace {

struct Params {
  int grid_size = 128;
  float depth_weight = 1;
  bool dynamic = false;
  enum class Fit { none, tight, stable } fit = Fit::none;
};

TechniqueInfo technique(const std::string& name, bool sampled) {
  static const ParamTable<Params> table = [] {
    ParamTable<Params> p;
    p.integer("grid_size", &Params::grid_size, 1, 16384, {"cells", "", "cells to a side"});
    p.number("depth_weight", &Params::depth_weight, 0, 1000, {"", "", "of depth among the axes"});
    p.boolean("dynamic", &Params::dynamic, {"", "", "rebuilt in every frame"});
    p.choice("fit", &Params::fit, {"none", "tight", "stable"}, {"", "", "of the map"});
    return p;
  }();
  TechniqueInfo info;
  info.name = name;
  info.params = table.infos();
  info.lights = {LightKind::rectangle, LightKind::point};
  info.sampled = sampled;
  return info;
}

}  // namespace

const Registry& fuzz_registry() {
  static const Registry registry = {technique("ray_tracing", true), technique("gears", true),
                                    technique("shadow_map", false)};
  return registry;
}

}  // namespace penumbra::test
