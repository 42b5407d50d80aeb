// View samples to the cells of the grid. STAGE 0 counts, and finds the farthest; STAGE 1 puts each into its cell's slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/gears/shaders/frame.glsl"
#include "techniques/gears/shaders/grid_camera.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 1) const uint STAGE = 0;
#include "techniques/common/shaders/subgroup.glsl"

layout(push_constant) uniform Push { BinSamplesConstants pc; };

void main() {
  uint i = linear_group() * SG + gl_SubgroupInvocationID, pixel = min(i, pc.pixels - 1u);
  vec4 o = pc.frame.f.origin.at[pixel];
  bool take = i < pc.pixels && reachable(pc.frame.f.light, o, pc.frame.f.normal.at[pixel].xyz, pc.slack);
  GridPoint q = project(pc.frame.f, to_working(pc.frame.f.light, o.xyz));
  uint cell = cell_of(pc.frame.f, pc.header.h, pc.grid_size, q);
  if (STAGE == 0u) {
    float z = highest(take ? q.z : 0.0);
    if (gl_SubgroupInvocationID == 0u && z > 0.0) atomicMax(pc.header.h.farthest, floatBitsToUint(z));
    if (take) atomicAdd(pc.counts.at[cell], 1u);
  } else if (take) {
    uint place = atomicAdd(pc.counts.at[cell], 1u), group = pc.first_groups.at[cell] + place / SG;
    pc.slots.at[group * SG + place % SG] = pixel;
    if (place % SG == 0u) pc.group_cells.at[group] = cell;
  }
}
