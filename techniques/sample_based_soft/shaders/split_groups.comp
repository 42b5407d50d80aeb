// Groups of view samples in a penumbra, and those of lists that no silhouette's region touches: there, all light samples
// above the horizon are seen or none [Sintorn2008, sec. 4.3].
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/sample_based_soft/shaders/frame.glsl"
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { SplitConstants pc; };

void main() {
  uint i = linear_invocation();
  if (i >= pc.groups) return;
  uint group = pc.first_group + i;
  if (pc.penumbrae.at[pc.group_lists.at[group]] != 0u)
    pc.work.at[atomicAdd(pc.header.h.soft_count, 1u)] = group;
  else
    pc.work.at[pc.capacity + atomicAdd(pc.header.h.hard_count, 1u)] = group;
}
