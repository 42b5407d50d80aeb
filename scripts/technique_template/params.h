// Parameters of @name@. Meaning and range of each field stand in params.cpp, once.
#pragma once
#include "technique/params.h"

namespace penumbra::@name@ {

struct Params {
  int triangles_per_dispatch = 512;
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::@name@
