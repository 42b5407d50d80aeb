// Parameters of line_space. Meaning and range of each field stand in params.cpp, once.
#pragma once
#include "technique/params.h"

namespace penumbra::line_space {

struct Params {
  enum class Build { host, device };
  enum class Backend { vulkan, cpu };
  enum class Cells { fitted, cubic };
  enum class Start { node, neighbours, coarse };  // in the order of START_... in shaders/shared.h

  int branching = 7;
  int depth = 3;
  Build build = Build::host;
  Backend backend = Backend::vulkan;
  Cells cells = Cells::cubic;
  Start start = Start::node;
  bool bounding_faces = false;
  int memory_limit_mib = 4096;
};

const ParamTable<Params>& param_table();

}  // namespace penumbra::line_space
