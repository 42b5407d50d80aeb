#include "techniques/depth_complexity_sampling/params.h"

namespace penumbra {

const ParamTable<DepthComplexityParams>& depth_complexity_params() {
  using P = DepthComplexityParams;
  static const ParamTable<P> table = [] {
    ParamTable<P> t;
    t.boolean(
        "dynamic", &P::dynamic,
        {"", "",
         "Take the vertices anew every frame: checks that welded vertices still coincide, and rebuilds the "
         "hierarchy of the one ray per view sample."});
    return t;
  }();
  return table;
}

}  // namespace penumbra
