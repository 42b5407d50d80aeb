#include "techniques/planar_shadow/params.h"

namespace penumbra::planar_shadow {

const ParamTable<Params>& param_table() {
  static const ParamTable<Params> table = [] {
    ParamTable<Params> t;
    t.integer("receiver", &Params::receiver, -1, 1000000,
              {"", "", "number of the instance that receives; -1: the flat one with the largest area"});
    return t;
  }();
  return table;
}

}  // namespace penumbra::planar_shadow
