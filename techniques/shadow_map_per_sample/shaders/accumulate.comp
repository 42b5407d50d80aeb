// One light sample's map joins the mean and the mask. Light samples come in order: the first starts the sum, each 32nd
// a word.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/shadow_map_per_sample/shaders/shared.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { AccumulatePush push; };

void main() {
  const uint pixel = linear_invocation();
  if (pixel >= push.pixels) return;
  const float lit = push.lit.at[pixel];
  const float before = push.light_sample == 0 ? 0 : push.visibility.at[pixel];
  push.visibility.at[pixel] = before + push.weight * lit;
  const uint word = pixel * push.mask_words + push.light_sample / 32, bit = push.light_sample % 32;
  const uint bits = bit == 0 ? 0 : push.mask.at[word];
  push.mask.at[word] = bits | (lit < 0.5 ? 1u << bit : 0);   // 1: blocked
}
