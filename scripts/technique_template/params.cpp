#include "techniques/@name@/params.h"

namespace penumbra::@name@ {

const ParamTable<Params>& param_table() {
  static const ParamTable<Params> table = [] {
    ParamTable<Params> t;
    t.integer(
        "triangles_per_dispatch", &Params::triangles_per_dispatch, 1, 1024,
        {"triangles", "",
         "Triangles that one dispatch tests. An invocation tests each against 32 light samples, and some "
         "drivers end loops silently after 65,535 turns."});
    return t;
  }();
  return table;
}

}  // namespace penumbra::@name@
