// What is seen of one light sample joins the mean and the mask. Light samples come in order: the first starts the sum, each
// 32nd a word.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/buffers.glsl"
#include "techniques/common/shaders/constants.h"
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { SampleMeanConstants pc; };

void main() {
  const uint pixel = linear_invocation();
  if (pixel >= pc.pixels) return;
  const float lit = pc.lit.at[pixel];
  const float before = pc.light_sample == 0 ? 0.0 : pc.visibility.at[pixel];
  pc.visibility.at[pixel] = before + pc.weight * lit;
  const uint word = pixel * pc.mask_words + pc.light_sample / 32, bit = pc.light_sample % 32;
  const uint bits = bit == 0 ? 0 : pc.masks.at[word];
  pc.masks.at[word] = bits | (lit < 0.5 ? 1u << bit : 0);   // 1: blocked
}
