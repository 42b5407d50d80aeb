// What shadow_map can be told. Meaning, unit and range of each field stand in params.cpp, once.
#pragma once
#include "technique/params.h"

namespace penumbra::shadow_map {

enum class Fit { none, tight, stable };
enum class DepthFormat { d16, d24, d32 };
enum class CasterFaces { both, front, back };
enum class PcfPattern { grid, poisson };

struct Params {
  int map_size = 1024;
  DepthFormat depth_format = DepthFormat::d32;
  Fit fit = Fit::tight;
  CasterFaces caster_faces = CasterFaces::both;
  float constant_bias = 1e-4f;
  float slope_bias = 3;
  bool receiver_plane_bias = false;
  int pcf_kernel = 3;
  PcfPattern pcf_pattern = PcfPattern::grid;
  int poisson_samples = 16;
  bool poisson_rotation = false;

  // Taps reach this far from the receiver's texel, in texels.
  double filter_radius() const { return 0.5 * pcf_kernel; }
  // Texels added around what is fitted, so that taps at its edge find depths.
  double border_texels() const { return filter_radius() + 1; }
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::shadow_map
