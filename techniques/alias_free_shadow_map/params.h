// What alias_free_shadow_map can be told. Meaning, unit and range of each field stand in params.cpp, once.
#pragma once
#include "technique/params.h"
#include "technique/technique.h"

namespace penumbra::alias_free {

enum class CasterFaces { back, both };

struct Params {
  int grid_size = 512;
  bool fit = true;
  CasterFaces casters = CasterFaces::back;
  Origin origin = Origin::automatic;
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::alias_free
