// Parameters of gears.
#pragma once
#include "technique/params.h"
#include "techniques/common/triangle_order.h"

namespace penumbra {

struct GearsParams {
  enum class Assignment { triangles, clusters };
  enum class Extrusion { conservative, paper };
  enum class Backend { vulkan, cpu };

  int grid_size = 128;
  Assignment assignment = Assignment::clusters;
  Extrusion extrusion_length = Extrusion::conservative;
  Backend backend = Backend::vulkan;
  SpatialOrder triangle_order = SpatialOrder::kd;
  int list_budget_mib = 256;
  int leaf_batch = 8;
  int dispatch_turns = 20000;
  int split_turns = 8000;
  float depth_weight = 1.0f;
};

const ParamTable<GearsParams>& gears_params();

}  // namespace penumbra
