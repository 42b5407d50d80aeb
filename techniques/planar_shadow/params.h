// What planar_shadow can be told. Meaning and range of each field stand in params.cpp, once.
#pragma once
#include "technique/params.h"

namespace penumbra::planar_shadow {

struct Params {
  int receiver = -1;
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::planar_shadow
