#include "techniques/soft_shadow_volume/params.h"

namespace penumbra::soft_shadow_volume {

const ParamTable<Params>& param_table() {
  static const ParamTable<Params> table = [] {
    ParamTable<Params> t;
    t.integer("split", &Params::split, 1, 8,
              {"", "",
               "a rectangle is split into so many times so many parts, each with its own silhouettes; the "
               "source shows 1, 2 and 3"})
        .cost();
    t.choice("wedges", &Params::wedges, {"tight", "loose"},
             {"", "",
              "what is drawn for an edge: the hull of the points that it hides a part of the light from, or "
              "the four planes of the original about the light's bounding sphere; changes the cost, never "
              "the picture"});
    t.choice("coverage", &Params::coverage, {"analytic", "table"},
             {"", "",
              "the area that an edge covers: by arithmetic, or by the slides' tables of angles and of the "
              "light's area between two of them"});
    t.integer("table_size", &Params::table_size, 4, 4096,
              {"entries", "", "intervals of the tables, per axis (coverage: table)"});
    return t;
  }();
  return table;
}

}  // namespace penumbra::soft_shadow_volume
