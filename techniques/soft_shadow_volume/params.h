// What soft_shadow_volume can be told. Meaning and range of each field stand in params.cpp, once.
#pragma once
#include "technique/params.h"

namespace penumbra::soft_shadow_volume {

enum class WedgeKind { tight, loose };
enum class Coverage { analytic, table };

struct Params {
  int split = 1;
  WedgeKind wedges = WedgeKind::tight;
  Coverage coverage = Coverage::analytic;
  int table_size = 256;
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::soft_shadow_volume
