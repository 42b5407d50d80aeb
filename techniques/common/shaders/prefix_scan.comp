// Exclusive prefix sums modulo 2^32, in three dispatches. STAGE 0: sums of blocks; 1: their prefix sums, by one
// invocation; 2: the elements. An element counts as ceil(value / DIVISOR). The total is kept in 64 bits, as multiples of
// 65,536 and the rest.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/buffers.glsl"
#include "techniques/common/shaders/constants.h"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 1) const uint STAGE = 0;
layout(constant_id = 2) const uint DIVISOR = 1;
#include "techniques/common/shaders/subgroup.glsl"

layout(push_constant) uniform Push { PrefixScanConstants pc; };

uint value(uint i) { return i < pc.count ? (pc.values.at[i] + DIVISOR - 1u) / DIVISOR : 0u; }

void main() {
  uint block = linear_group(), lane = gl_SubgroupInvocationID;
  if (STAGE == 1u) {
    if (block > 0u || lane > 0u) return;
    uint before = 0u, low = 0u, high = 0u;
    for (uint b = 0u; b < pc.block_count; b++) {
      uint l = pc.blocks.at[2u + 2u * b], h = pc.blocks.at[3u + 2u * b];
      pc.blocks.at[2u + 2u * b] = before;
      before += (h << 16u) + l;
      low += l;
      high += h + (low >> 16u);
      low &= 0xffffu;
    }
    pc.blocks.at[0] = low;
    pc.blocks.at[1] = high;
    return;
  }
  if (block >= pc.block_count) return;
  uint first = (block * SG + lane) * pc.per_lane, low = 0u, high = 0u, mine = 0u;
  for (uint k = 0u; k < pc.per_lane; k++) {
    uint v = value(first + k);
    mine += v;
    low += v & 0xffffu;
    high += v >> 16u;
  }
  if (STAGE == 0u) {
    low = sum_of_all(low);
    high = sum_of_all(high);
    if (lane == 0u) {
      pc.blocks.at[2u + 2u * block] = low;
      pc.blocks.at[3u + 2u * block] = high;
    }
    return;
  }
  uint inclusive = mine;
  for (uint s = 1u; s < SG; s <<= 1u) {
    uint other = subgroupShuffle(inclusive, lane >= s ? lane - s : lane);
    inclusive += lane >= s ? other : 0u;
  }
  uint at = pc.blocks.at[2u + 2u * block] + inclusive - mine;
  for (uint k = 0u; k < pc.per_lane; k++) {
    if (first + k < pc.count) pc.sums.at[first + k] = at;
    at += value(first + k);
  }
}
