// Parameters of depth_complexity_sampling.
#pragma once
#include "technique/params.h"

namespace penumbra {

struct DepthComplexityParams {
  bool dynamic = false;
};

const ParamTable<DepthComplexityParams>& depth_complexity_params();

}  // namespace penumbra
