// Visibility: the weighted share of clear bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/line_space/shaders/buffers.glsl"
layout(push_constant, scalar) uniform Push { ResolvePush push; };

void main() {
  const uint pixel = linear_invocation();
  if (pixel >= push.pixels) return;
  uint blocked = 0u;
  float lit = 0.0;
  for (uint w = 0u; w < push.words; ++w) {
    uint bits = push.mask.at[pixel * push.words + w];
    blocked += bitCount(bits);
    const uint in_word = min(32u, push.samples - 32u * w);
    if (push.weight == 0.0)
      for (uint b = 0u; b < in_word; ++b) lit += (bits >> b & 1u) == 0u ? push.weights.at[32u * w + b] : 0.0;
  }
  if (push.weight != 0.0) lit = float(push.samples - blocked) / float(push.samples);
  push.visibility.at[pixel] = min(lit, 1.0);
}
