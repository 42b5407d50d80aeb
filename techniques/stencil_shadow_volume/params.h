// What stencil_shadow_volume can be told. Meaning and range of each field stand in params.cpp, once.
#pragma once
#include "technique/params.h"

namespace penumbra::shadow_volume {

enum class Variant { z_pass, z_fail, zp_plus };
enum class Extrusion { per_triangle, silhouette };
enum class Casters { all, light_back_facing };

enum class Counter { automatic, stencil, wide };

struct Params {
  Variant variant = Variant::z_fail;
  Extrusion extrusion = Extrusion::silhouette;
  Casters casters = Casters::all;
  Counter counter = Counter::automatic;
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::shadow_volume
