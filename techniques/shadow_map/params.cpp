#include "techniques/shadow_map/params.h"

namespace penumbra::shadow_map {

const ParamTable<Params>& param_table() {
  static const ParamTable<Params> table = [] {
    ParamTable<Params> t;
    t.integer("map_size", &Params::map_size, 16, 16384,
              {"texels", "", "side of the square depth map, or of each face or cascade"})
        .cost();
    t.choice("depth_format", &Params::depth_format, {"d16", "d24", "d32"},
             {"", "", "depth of a texel: 16- or 24-bit fixed point, 32-bit float"});
    t.choice("fit", &Params::fit, {"none", "tight", "stable"},
             {"", "",
              "what the map covers: the scene's bounds (a spot's cone), the view samples' bounds in the "
              "light's view, or "
              "these with a quantised size and snapped to whole texels"});
    t.choice("caster_faces", &Params::caster_faces, {"both", "front", "back"},
             {"", "", "triangles drawn into the map, by the side that they turn to the light"});
    t.number("constant_bias", &Params::constant_bias, 0, 0.1,
             {"scene diagonals", "",
              "the receiver is moved this far towards the light before its depth is compared"});
    t.number("slope_bias", &Params::slope_bias, 0, 100,
             {"texels", "",
              "casters are pushed away from the light by the depth that their plane gains over this many "
              "texels; 1 covers "
              "an unfiltered map, k a kernel of k x k"});
    t.boolean(
        "receiver_plane_bias", &Params::receiver_plane_bias,
        {"", "", "compare each tap with the depth that the receiver's plane has at the tap's texel centre"});
    t.integer("pcf_kernel", &Params::pcf_kernel, 1, 63,
              {"texels", "", "side of the percentage-closer kernel; 1 is the unfiltered map"})
        .cost();
    t.choice("pcf_pattern", &Params::pcf_pattern, {"grid", "poisson"},
             {"", "",
              "taps: all pcf_kernel x pcf_kernel texels, or poisson_samples in the disc of that diameter"});
    t.integer("poisson_samples", &Params::poisson_samples, 1, 64, {"taps", "", "taps of the Poisson disc"})
        .cost();
    t.boolean("poisson_rotation", &Params::poisson_rotation,
              {"", "", "turn the disc by an angle of its own in each pixel: noise in place of banding"});
    return t;
  }();
  return table;
}

}  // namespace penumbra::shadow_map
