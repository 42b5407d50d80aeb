// What shadow_map can be told. Meaning, unit and range of each field stand in params.cpp, once.
#pragma once
#include <bit>

#include "technique/params.h"

namespace penumbra::shadow_map {

enum class Fit { none, tight, stable };
enum class DepthFormat { d16, d24, d32 };
enum class CasterFaces { both, front, back };
enum class PcfPattern { grid, poisson };
enum class Warp { none, psm, tsm, lispsm, log };
enum class Split { uniform, log, practical };
enum class Filter { pcf, pcss, vsm, evsm, msm };
enum class Blur { box, gaussian };
enum class MomentFormat { float32, bits16 };
enum class MomentFiltering { bilinear, trilinear, anisotropic };

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

  Warp warp = Warp::none;
  float lispsm_n = 1;
  float tsm_focus = 0.2f;
  int cascades = 1;
  Split cascade_split = Split::practical;
  float cascade_lambda = 0.5f;
  Filter filter = Filter::pcf;
  int pcss_search = 8;
  float pcss_border = 0.125f;
  int filter_size = 5;
  Blur blur = Blur::box;
  MomentFiltering moment_filtering = MomentFiltering::bilinear;
  int max_anisotropy = 16;
  MomentFormat moment_format = MomentFormat::float32;
  float bleeding_reduction = 0.2f;
  float min_variance = 1e-6f;
  float evsm_positive = 40;
  float evsm_negative = 5;
  float moment_bias = 1e-5f;

  bool filterable() const { return filter == Filter::vsm || filter == Filter::evsm || filter == Filter::msm; }
  // Levels of a filterable map: each half as wide as the one before, down to one texel.
  int moment_levels() const {
    if (!filterable() || moment_filtering == MomentFiltering::bilinear) return 1;
    return std::bit_width(static_cast<unsigned>(map_size));
  }
  // Texels added around what is fitted, so that taps at its edge find depths.
  double border_texels() const {
    if (filter == Filter::pcss) return double(pcss_border) * map_size + 1;
    return 0.5 * (filterable() ? filter_size + 1 : pcf_kernel) + 1;
  }
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::shadow_map
