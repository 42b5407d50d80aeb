// View samples to the cells of the grid. STAGE 0 counts, and finds the farthest; STAGE 1 puts each into its cell's slots.
// Each lane does PER_LANE view samples, so that the constants are fetched once for all of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/gears/shaders/frame.glsl"
#include "techniques/gears/shaders/grid_camera.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 1) const uint STAGE = 0;
layout(constant_id = 2) const uint PER_LANE = 16;
#include "techniques/common/shaders/subgroup.glsl"

layout(set = 0, binding = 0) uniform Texels frame_texels;    // FrameConstants
layout(set = 0, binding = 1) uniform Texels origin_texels;   // per pixel: P' (w = 0: no view sample),
layout(set = 0, binding = 2) uniform Texels normal_texels;   // Ng
layout(push_constant) uniform Push { BinSamplesConstants pc; };

void main() {
  FrameConstants f = camera_constants(frame_texels);
  Header h = pc.header.h;
  float farthest = 0.0;
  for (uint k = 0u; k < PER_LANE; k++) {
    uint i = (linear_group() * PER_LANE + k) * SG + gl_SubgroupInvocationID, pixel = min(i, pc.pixels - 1u);
    vec4 o = texel(origin_texels, pixel);
    bool take = i < pc.pixels && reachable(f.light, o, texel(normal_texels, pixel).xyz, pc.slack);
    GridPoint q = project(f, to_working(f.light, o.xyz));
    uint cell = cell_of(f, h, pc.grid_size, q);
    if (STAGE == 0u) {
      farthest = take ? upper(farthest, q.z) : farthest;
      if (take) atomicAdd(pc.counts.at[cell], 1u);
    } else if (take) {
      uint place = atomicAdd(pc.counts.at[cell], 1u), group = pc.first_groups.at[cell] + place / SG;
      pc.slots.at[group * SG + place % SG] = pixel;
      if (place % SG == 0u) pc.group_cells.at[group] = cell;
    }
  }
  if (STAGE != 0u) return;
  farthest = highest(farthest);
  if (gl_SubgroupInvocationID == 0u && farthest > 0.0) atomicMax(pc.header.h.farthest, floatBitsToUint(farthest));
}
