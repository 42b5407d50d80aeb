// View samples to lists [Sintorn2008, sec. 3.1]. STAGE 0 counts, and keeps each one's place; between the stages the
// counts are summed up; STAGE 1 writes the lists, one dense array. A list is kept in slices of depth, so that view
// samples that stand side by side in it are neighbours in space.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/sample_based_soft/shaders/frame.glsl"
#include "techniques/sample_based_soft/shaders/lists.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 1) const uint STAGE = 0;
layout(constant_id = 2) const bool FIT = true;
layout(push_constant) uniform Push { SamplesConstants pc; };

// What is the same for all view samples is loaded once for several of them: loads are what this kernel costs.
void count(uint first) {
  FrameConstants f;
  f.window = pc.frame.f.window;
  f.widest = pc.frame.f.widest;
  const Window window = window_of(f, pc.header, pc.grid_size, FIT);
  const float per_depth = float(pc.slices) / from_ordered(~pc.header.h.farthest);
  for (uint k = 0u; k < pixels_per_lane; k++) {
    uint pixel = first + k * SG;
    if (pixel >= pc.pixels) break;
    vec4 place = pc.places.at[pixel];
    bool lit = place.w > 0.0;
    uint list = outside_list(pc.grid_size), slice = 0u;
    if (place.w == 1.0) {
      list = list_of(window, pc.grid_size, place.xy);
      slice = uint(clamp(place.z * per_depth, 0.0, float(pc.slices - 1u)));
      atomicMax(pc.farthest.at[list], floatBitsToUint(place.z));
    }
    uint bin = list * pc.slices + slice;
    pc.bins.at[2u * pixel] = lit ? bin : no_sample;
    if (lit) pc.bins.at[2u * pixel + 1u] = atomicAdd(pc.counts.at[bin], 1u);
  }
}

void write(uint first) {
  for (uint k = 0u; k < pixels_per_lane; k++) {
    uint pixel = first + k * SG;
    if (pixel >= pc.pixels) break;
    uint bin = pc.bins.at[2u * pixel];
    if (bin != no_sample) {
      uint list = bin / pc.slices, group = pc.first_groups.at[list];
      uint at = pc.begins.at[bin] - pc.begins.at[list * pc.slices] + pc.bins.at[2u * pixel + 1u];
      pc.slots.at[group * SG + at] = pixel;
      if (at % SG == 0u) pc.group_lists.at[group + at / SG] = list;
    }
  }
}

void main() {
  uint first = linear_group() * SG * pixels_per_lane + gl_LocalInvocationID.x;
  if (STAGE == 0u) count(first);
  if (STAGE == 1u) write(first);
}
