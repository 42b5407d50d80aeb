// Writes a level's nodes into the node pool and their children groups into the tree pool.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/line_space/shaders/buffers.glsl"
layout(push_constant, scalar) uniform Push { FillPush push; };

void main() {
  const uint index = linear_invocation();
  if (index >= push.count) return;
  const uint group = (push.base + index) * N * N * N;
  Node node = push.nodes.at[index];
  node.children = group;
  push.node_pool.at[push.base + index] = node;
  uint child = push.last_level == 0u ? push.next_base + push.first_child.at[index] : 0u;
  for (uint w = 0u; w < occupancy_words; ++w) {
    const uint bits = push.occupancy.at[index * occupancy_words + w];
    for (uint b = 0u; b < 32u && 32u * w + b < N * N * N; ++b) {
      const bool occupied = (bits >> b & 1u) != 0u;
      const uint entry = push.last_level == 1u ? occupied_leaf : child;
      push.tree_pool.at[group + 32u * w + b] = occupied ? entry : empty_leaf;
      child += occupied ? 1u : 0u;
    }
  }
}
