// What this room's kernels share.
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/line_space/shaders/shared.h"
layout(local_size_x = group_lanes) in;
layout(constant_id = 0) const uint N = 7;
const uint occupancy_words = (N * N * N + 31u) / 32u;  // of a node
