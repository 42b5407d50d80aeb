// What sample_based_soft can be told. Meaning, unit and range of each field stand in params.cpp, once.
#pragma once
#include "technique/params.h"
#include "techniques/common/triangle_order.h"

namespace penumbra::sample_based_soft {

struct Params {
  enum class HalfSpaces { exact, table };
  enum class Regions { blocks, triangles };
  enum class FarPlane { list, scene };

  int grid_size = 128;
  HalfSpaces half_spaces = HalfSpaces::exact;
  int table_size = 128;
  Regions regions = Regions::blocks;
  FarPlane far_plane = FarPlane::list;
  bool fit = true;
  bool skip_empty_lists = true;
  bool restrict_to_penumbra = false;
  bool cull_back_faces = true;
  bool cull_supporting_planes = true;
  SpatialOrder triangle_order = SpatialOrder::kd;
  float transparency = 0;
  bool coherent_shading = false;
  float bend_weight = 3;
  int list_budget_mib = 256;
  int dispatch_turns = 20000;
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::sample_based_soft
