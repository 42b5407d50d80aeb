// The corners of each triangle side by side, for fetching: see cast.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CornersPush push; };

void main() {
  const uint t = linear_group() * group_lanes + gl_LocalInvocationIndex;
  if (t >= push.count) return;
  const float closed = (push.closed.at[t >> 5u] >> (t & 31u) & 1u) != 0u ? 1.0 : 0.0;
  for (uint k = 0u; k < 3u; ++k)
    push.corners.at[3u * t + k] = vec4(push.positions.at[push.indices.at[3u * t + k]], k == 0u ? closed : 0.0);
}
