#include "techniques/stencil_shadow_volume/params.h"

namespace penumbra::shadow_volume {

const ParamTable<Params>& param_table() {
  static const ParamTable<Params> table = [] {
    ParamTable<Params> t;
    t.choice(
        "variant", &Params::variant, {"z_pass", "z_fail", "zp_plus"},
        {"", "c",
         "which faces of the volumes count: those before the view sample (wrong where the camera is inside "
         "a volume), those behind it, or those before it on top of what the near plane already lies in"});
    t.choice("extrusion", &Params::extrusion, {"per_triangle", "silhouette"},
             {"", "", "one volume per triangle, or sides on the edges alone where these do not cancel"});
    t.choice(
        "casters", &Params::casters, {"all", "light_back_facing"},
        {"", "",
         "triangles that cast: all (any mesh), or those that turn their back to the light (closed meshes, "
         "half the fill)"});
    t.choice(
        "counter", &Params::counter, {"automatic", "stencil", "wide"},
        {"", "",
         "what counts: the 8-bit stencil, which wraps at 256 volumes; floats, which do not; automatic: the "
         "stencil where build has proved that no more than 250 volumes lie over each other, else floats"});
    return t;
  }();
  return table;
}

}  // namespace penumbra::shadow_volume
