#include "techniques/alias_free_shadow_map/params.h"

namespace penumbra::alias_free {

const ParamTable<Params>& param_table() {
  static const ParamTable<Params> table = [] {
    ParamTable<Params> t;
    t.integer("grid_size", &Params::grid_size, 1, 4096,
              {"texels", "SM",
               "side of the square array of lists in the light's view (of each of six faces); changes the "
               "cost, never "
               "the picture"})
        .axis();
    t.boolean(
        "fit", &Params::fit,
        {"", "", "fit the light's window to the projected view samples; else it covers the scene's bounds"});
    t.choice(
        "casters", &Params::casters, {"back", "both"},
        {"", "",
         "triangles of closed meshes that cast: those that turn away from the light, or all; those of open "
         "meshes always all"});
    t.choice(
        "origin", &Params::origin, {"offset", "exact", "auto"},
        {"", "",
         "where shadow segments begin: at the offset point that sampled techniques share; at the view "
         "sample itself, its own triangle left out, without bias of any kind; auto: the latter where all "
         "meshes of the scene are closed, else the former"});
    return t;
  }();
  return table;
}

}  // namespace penumbra::alias_free
