// From the stencils of up to 8 light samples each to masks, and to visibility, the weighted share of clear bits. An
// invocation takes 4 pixels: a word of each stencil. What it loads is what it costs, so what is the same for all pixels
// (which light samples are below the receiver's horizon) comes as words of a mask, and only where that cannot be told
// beforehand is each light sample tested at each pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/planar_shadow/shaders/shared.h"
#include "techniques/common/shaders/light_emission.glsl"
layout(local_size_x = PLANAR_GROUP) in;
layout(constant_id = 0) const bool each_pixel = false;  // the horizon is tested there
layout(push_constant, scalar) uniform Push { GatherPush push; };

const uint no_triangle = 0xffffffffu;

// Bits of one word, sample by sample.
uint below_horizon(uint pixel, uint first, uint samples) {
  const vec3 p = push.position.at[pixel].xyz, n = push.normal.at[pixel].xyz;
  uint blocked = 0;
  for (uint i = 0; i < samples; ++i)
    if (!may_be_lit(p, n, push.points.at[first + i], push.emission)) blocked |= 1u << i;
  return blocked;
}

float lit_share(uint blocked, uint first, uint samples) {
  if (push.weight > 0) return float(samples - bitCount(blocked)) * push.weight;
  float lit = 0;
  for (uint i = 0; i < samples; ++i) lit += (blocked >> i & 1) == 0 ? push.weights.at[first + i] : 0.0;
  return lit;
}

void main() {
  const uint quad = linear_invocation(), pixel = 4 * quad;
  if (pixel >= push.pixels) return;
  const uint many = min(4, push.pixels - pixel), stride = (push.pixels + 3) / 4;
  uint received = 0;  // bytes
  for (uint k = 0; k < many; ++k) {
    const uint t = push.triangle.at[pixel + k];
    if (t != no_triangle && (push.on_receiver.at[t >> 5] >> (t & 31) & 1) != 0) received |= 0xffu << 8 * k;
  }
  uint behind = 0;  // the rectangle, whose samples are all in one plane
  if (!each_pixel && push.emission.w == 0)
    for (uint k = 0; k < many; ++k)
      if (dot(push.emission.xyz, push.position.at[pixel + k].xyz - push.points.at[0].xyz) < 0) behind |= 1u << k;
  vec4 lit = vec4(0);
  for (uint first = push.first; first < push.end; first += 32) {
    const uint samples = min(32, push.end - first), slice = (first - push.first) / 8;
    uvec4 stencil = uvec4(0);
    for (uint j = 0; 8 * j < samples; ++j) stencil[j] = push.stencil.at[(slice + j) * stride + quad] & received;
    const uint all = samples == 32 ? ~0u : (1u << samples) - 1;
    const uint dark = each_pixel ? 0 : push.dark.at[first >> 5];
    for (uint k = 0; k < many; ++k) {
      const uvec4 bytes = (stencil >> 8 * k & 0xffu) << uvec4(0, 8, 16, 24);
      uint blocked = bytes.x | bytes.y | bytes.z | bytes.w;
      if ((received >> 8 * k & 1) != 0) blocked |= each_pixel ? below_horizon(pixel + k, first, samples)
                                                                    : (behind >> k & 1) != 0 ? all : dark;
      push.mask.at[(pixel + k) * push.words + (first >> 5)] = blocked;
      lit[k] += lit_share(blocked, first, samples);
    }
  }
  for (uint k = 0; k < many; ++k) {
    const bool answered = (received >> 8 * k & 1) != 0;
    const float before = push.first == 0 ? 0.0 : push.visibility.at[pixel + k];
    push.visibility.at[pixel + k] = answered ? before + lit[k] : 1.0;
  }
}
