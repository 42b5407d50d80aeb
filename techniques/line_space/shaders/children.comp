// Of each node of a level: STAGE 0 counts its occupied subnodes, STAGE 1 makes them nodes of the next level.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/line_space/shaders/buffers.glsl"
layout(constant_id = 1) const uint STAGE = 0;
layout(push_constant, scalar) uniform Push { ChildrenPush push; };

void main() {
  const uint index = linear_invocation();
  if (index >= push.count) return;
  uint found = 0u;
  const uint first = STAGE == 1u ? push.first_child.at[index] : 0u;
  const Node node = push.nodes.at[index];
  for (uint w = 0u; w < occupancy_words; ++w) {
    uint bits = push.occupancy.at[index * occupancy_words + w];
    if (STAGE == 0u) {
      found += bitCount(bits);
      continue;
    }
    for (; bits != 0u; bits &= bits - 1u) {
      const uint subnode = 32u * w + findLSB(bits), n = push.subnode;
      push.next_nodes.at[first + found] = Node(0u, node.x + subnode % N * n, node.y + subnode / N % N * n,
                                               node.z + subnode / (N * N) * n);
      ++found;
    }
  }
  if (STAGE == 0u) push.counts.at[index] = found;
}
