// From words in the order of the lists to visibility in the order of the pixels. View samples in no list face away from
// the light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ResolvePush push; };

void main() {
  const uint pixel = linear_group() * group_lanes + gl_LocalInvocationIndex;
  if (pixel >= push.count) return;
  const uint slot = push.slots.at[pixel];
  float visibility = 0.0;
  if (slot != no_slot) visibility = push.blocked.at[slot] == 0u ? 1.0 : 0.0;
  push.visibility.at[pixel] = visibility;
}
