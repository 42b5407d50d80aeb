// Visibility from the counts: lit where no volume holds the view sample, and the light shines on its visible side.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/stencil_shadow_volume/shaders/buffers.glsl"
#include "techniques/common/shaders/light_emission.glsl"
layout(local_size_x = VOLUME_GROUP) in;
layout(constant_id = 0) const bool wide = false;  // counts are floats
layout(push_constant, scalar) uniform Push { ResolvePush push; };

void main() {
  const uint pixel = linear_invocation();
  if (pixel >= push.count) return;
  const uint count = wide ? push.counts.at[pixel] & 0x7fffffffu : (push.counts.at[pixel >> 2] >> (8 * (pixel & 3))) & 0xffu;
  const bool lit = count == 0 && may_be_lit(push.position.at[pixel].xyz, push.normal.at[pixel].xyz, push.light, push.emission);
  push.visibility.at[pixel] = lit ? 1.0 : 0.0;
}
