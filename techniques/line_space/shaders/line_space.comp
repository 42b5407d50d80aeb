// One word of a node's line space: the shafts that meet any occupied subnode.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/line_space/shaders/buffers.glsl"
layout(push_constant, scalar) uniform Push { LineSpacePush push; };
const uint words = (15u * N * N * N * N + 31u) / 32u;

void main() {
  const uint groups_per_node = (words + group_lanes - 1u) / group_lanes;
  const uint group = linear_group(), index = group / groups_per_node;
  const uint word = group % groups_per_node * group_lanes + gl_LocalInvocationID.x;
  if (index >= push.count || word >= words) return;
  uint shafts = 0u;
  for (uint w = 0u; w < occupancy_words; ++w)
    for (uint bits = push.occupancy.at[index * occupancy_words + w]; bits != 0u; bits &= bits - 1u)
      shafts |= push.rows.at[(32u * w + findLSB(bits)) * words + word];
  push.line_space_pool.at[(push.base + index) * words + word] = shafts;
}
