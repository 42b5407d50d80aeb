// From the stencil of up to 8 light samples to their bits of the mask, and to visibility, their weighted mean.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/planar_shadow/shaders/shared.h"
#include "techniques/common/shaders/light_emission.glsl"
layout(local_size_x = PLANAR_GROUP) in;
layout(push_constant, scalar) uniform Push { GatherPush push; };

const uint no_triangle = 0xffffffffu;

void main() {
  const uint pixel = linear_invocation();
  if (pixel >= push.pixels) return;
  const uint t = push.triangle.at[pixel];
  const bool received = t != no_triangle && (push.on_receiver.at[t >> 5] >> (t & 31) & 1) != 0;
  uint blocked = received ? push.stencil.at[pixel >> 2] >> (8 * (pixel & 3)) & 0xffu : 0u;
  const vec3 p = push.position.at[pixel].xyz, n = push.normal.at[pixel].xyz;
  const uint samples = min(8, push.count - push.first);
  float lit = 0;
  for (uint i = 0; i < samples; ++i) {
    if (received && !may_be_lit(p, n, push.points.at[push.first + i], push.emission)) blocked |= 1u << i;
    lit += (blocked >> i & 1) == 0 ? push.weights.at[push.first + i] : 0.0;
  }
  const uint word = pixel * push.words + push.first / 32, shift = push.first % 32;
  push.mask.at[word] = (shift == 0 ? 0 : push.mask.at[word]) | blocked << shift;
  push.visibility.at[pixel] = push.first == 0 ? lit : push.visibility.at[pixel] + lit;
}
