// STAGE 0: the lengths of the lists. STAGE 1: the farthest view sample of each tile of lists.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/sample_based_soft/shaders/frame.glsl"
#include "techniques/sample_based_soft/shaders/lists.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 1) const uint STAGE = 0;
layout(push_constant) uniform Push { SamplesConstants pc; };

void main() {
  uint i = linear_invocation(), lists = list_count(pc.grid_size);
  if (STAGE == 0u) {
    if (i < lists) pc.lengths.at[i] = pc.begins.at[(i + 1u) * pc.slices] - pc.begins.at[i * pc.slices];
    return;
  }
  if (i >= lists / tile_lists) return;
  uint farthest = 0u;
  for (uint k = 0u; k < tile_lists; k++) farthest = max(farthest, pc.farthest.at[i * tile_lists + k]);
  pc.farthest.at[lists + i] = farthest;
}
