// Four words of a node's line space: the shafts that meet any occupied subnode.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/line_space/shaders/buffers.glsl"
#include "techniques/line_space/shaders/words.glsl"
layout(set = 0, binding = 0) uniform usampler2D rows;  // of the shaft table, each in whole texels
layout(push_constant, scalar) uniform Push { LineSpacePush push; };
const uint words = (15u * N * N * N * N + 31u) / 32u;
const uint texels = (words + 3u) / 4u;

void main() {
  const uint groups_per_node = (texels + group_lanes - 1u) / group_lanes;
  const uint group = linear_group(), index = group / groups_per_node;
  const uint texel = group % groups_per_node * group_lanes + gl_LocalInvocationID.x;
  if (index >= push.count || texel >= texels) return;
  uvec4 shafts = uvec4(0u);
  for (uint w = 0u; w < occupancy_words; ++w)
    for (uint bits = push.occupancy.at[index * occupancy_words + w]; bits != 0u; bits &= bits - 1u)
      shafts |= fetch_words(rows, (32u * w + findLSB(bits)) * texels + texel);
  const uint first = (push.base + index) * words + 4u * texel;
  for (uint k = 0u; k < 4u && 4u * texel + k < words; ++k)
    push.line_space_pool.at[first + k] = k == 0u ? shafts.x : k == 1u ? shafts.y : k == 2u ? shafts.z : shafts.w;
}
