// Adds 1 to its own element `turns` times over.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
layout(local_size_x = 8) in;
layout(push_constant) uniform Push { FloatArray values; uint turns; uint groups; } pc;

void main() {
  if (linear_group() >= pc.groups) return;
  float x = 0.0;
  for (uint i = 0u; i < pc.turns; ++i) x = x * 0.5 + 1.0;
  uint at = pc.turns == 1u ? linear_invocation() : (linear_invocation() & 63u);
  pc.values.at[at] = x;
}
