#include "techniques/common/shadow_maps/params.h"

namespace penumbra::shadow_map {

namespace {

void add_partitioning(ParamTable<Params>& t) {
  t.choice(
      "warp", &Params::warp, {"none", "psm", "tsm", "lispsm", "log"},
      {"", "", "perspective, trapezoidal, light-space perspective or logarithmic perspective shadow map"});
  t.number("lispsm_n", &Params::lispsm_n, 0.01, 1000,
           {"", "n / n_opt",
            "distance of the warp's centre as a multiple of the source's optimum; larger warps less"});
  t.number("tsm_focus", &Params::tsm_focus, 0.01, 1,
           {"", "", "share of the view samples' depth range that gets 80 % of a trapezoidal map"});
  t.integer("cascades", &Params::cascades, 1, 8,
            {"maps", "m", "view depth is split into this many ranges, a map for each"})
      .cost();
  t.choice("cascade_split", &Params::cascade_split, {"uniform", "log", "practical"},
           {"", "", "where ranges end: at equal steps, equal ratios, or a blend of both"});
  t.number("cascade_lambda", &Params::cascade_lambda, 0, 1,
           {"", "lambda", "weight of the logarithmic split in the practical one"});
}

void add_filters(ParamTable<Params>& t) {
  t.choice("filter", &Params::filter, {"pcf", "pcss", "vsm", "evsm", "msm"},
           {"", "",
            "percentage-closer filtering, percentage-closer soft shadows, or a variance, exponential "
            "variance or moment "
            "shadow map"});
  t.integer("pcss_search", &Params::pcss_search, 1, 32,
            {"taps", "", "side of the blocker search's grid of taps; the filter itself takes pcf_kernel's"})
      .cost();
  t.number("pcss_border", &Params::pcss_border, 0, 0.24,
           {"share of map_size", "",
            "room on each side of the fitted window for search and filter; both stop there"});
  t.integer("filter_size", &Params::filter_size, 1, 63,
            {"texels", "", "side of the blur of filterable maps; 1 is none"})
      .cost();
  t.choice("blur", &Params::blur, {"box", "gaussian"},
           {"", "", "weights of that blur; the Gaussian's standard deviation is a quarter of filter_size"});
  t.choice(
      "moment_filtering", &Params::moment_filtering, {"bilinear", "trilinear", "anisotropic"},
      {"", "",
       "how a filterable map is read: between four texels, or from a mip chain by the pixel's footprint, "
       "round or along its longer axis"});
  t.integer("max_anisotropy", &Params::max_anisotropy, 2, 16,
            {"probes", "", "most probes along that axis (anisotropic)"})
      .cost();
  t.choice(
      "moment_format", &Params::moment_format, {"float32", "bits16"},
      {"", "", "each moment: a float; or a half (vsm, evsm), 16 bits with the optimised quantisation (msm)"});
  t.number("bleeding_reduction", &Params::bleeding_reduction, 0, 0.99,
           {"", "", "visibility below this becomes 0 and the rest is stretched to 1 (filterable maps)"});
  t.number("min_variance", &Params::min_variance, 0, 0.1,
           {"squared depth range", "",
            "variance is at least this (vsm; evsm: after scaling to the warped depth)"});
  t.number("evsm_positive", &Params::evsm_positive, 0.1, 42,
           {"", "c+", "positive exponent; at most 5.54 with bits16"});
  t.number("evsm_negative", &Params::evsm_negative, 0.1, 42,
           {"", "c-", "negative exponent; at most 5.54 with bits16"});
  t.number("moment_bias", &Params::moment_bias, 0, 0.1,
           {"", "alpha",
            "weight of the bias added to moments: 3e-5 for bits16; float32 needs 1e-5 to keep lit planes "
            "free of noise"});
}

}  // namespace

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
    add_partitioning(t);
    add_filters(t);
    return t;
  }();
  return table;
}

}  // namespace penumbra::shadow_map
