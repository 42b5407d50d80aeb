// From the masks as walked to the masks as handed out, and their visibility. Bits that no light sample owns become 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_EXT_control_flow_attributes : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/buffers.glsl"
#include "techniques/common/shaders/constants.h"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint LANES = 64;
layout(constant_id = 1) const uint SAMPLES = 256;
layout(constant_id = 2) const uint COLUMNS = 16;       // of a row
layout(constant_id = 3) const uint PITCH = 16;         // bits that a row takes in the walked mask
layout(constant_id = 4) const uint WORDS = 8;          // of the walked mask
layout(constant_id = 5) const bool PACKED = true;      // both masks have one layout
layout(constant_id = 6) const bool WEIGHTED = false;
layout(constant_id = 7) const bool CLUSTERED = false;  // light sample i is bit places[i] of the walked mask

layout(push_constant) uniform Push { MaskResolveConstants pc; };

const uint HALF = PITCH > 32 ? 2 : 1;   // words of a row that takes more than one

uint owned(uint word) { return SAMPLES - 32u * word >= 32u ? 0xffffffffu : (1u << (SAMPLES - 32u * word)) - 1u; }

void unpack(uint pixel) {
  uint word = 0u, fill = 0u, current = 0u;
  for (uint row = 0u; row * COLUMNS < SAMPLES; row++)
    for (uint part = 0u; part < HALF; part++) {
      uint bit = row * PITCH + 32u * part, n = min(COLUMNS - 32u * part, 32u);
      uint bits = pc.walked.at[pixel * WORDS + bit / 32u] >> (bit % 32u);
      bits &= n >= 32u ? 0xffffffffu : (1u << n) - 1u;
      current |= bits << fill;
      if (fill + n >= 32u) {
        pc.masks.at[pixel * pc.mask_words + word] = current;
        word++;
        uint used = 32u - fill;
        current = used >= 32u ? 0u : bits >> used;
        fill = fill + n - 32u;
      } else {
        fill += n;
      }
    }
  if (fill > 0u) pc.masks.at[pixel * pc.mask_words + word] = current;
}

// Places are the same for all pixels: a subgroup loads as many as it has lanes at once. Where all its pixels see the whole
// light or nothing of it, order does not matter.
void gather(uint pixel, bool real) {
  uint walked[WORDS], and_ = 0xffffffffu, or_ = 0u;
  [[unroll]] for (uint k = 0u; k < WORDS; k++) {
    walked[k] = pc.walked.at[pixel * WORDS + k];
    and_ &= walked[k] | ~owned(k);
    or_ |= walked[k] & owned(k);
  }
  bool mixed = or_ != 0u && and_ != 0xffffffffu;
  uint words = subgroupAny(mixed) ? pc.mask_words : 0u;
  for (uint k = words; k < pc.mask_words; k++)
    if (real) pc.masks.at[pixel * pc.mask_words + k] = and_ & owned(k);
  for (uint k = 0u; k < words; k++) {
    uint w = 0u;
    for (uint b = 0u; b < 32u; b += gl_SubgroupSize) {
      uint mine = pc.places.at[min(32u * k + b + gl_SubgroupInvocationID, SAMPLES - 1u)];
      for (uint l = 0u; l < min(gl_SubgroupSize, 32u); l++) {
        uint place = subgroupShuffle(mine, l), bits = 0u;
        // Comparisons, not walked[place >> 5]: a place that varies costs more.
        [[unroll]] for (uint q = 0u; q < WORDS; q++) bits = place >> 5u == q ? walked[q] : bits;
        w |= (bits >> (place & 31u) & 1u) << (b + l);
      }
    }
    if (real) pc.masks.at[pixel * pc.mask_words + k] = w & owned(k);
  }
}

void main() {
  uint pixel = linear_group() * LANES + gl_LocalInvocationID.x;
  // All lanes of a subgroup go on where they shuffle.
  if (CLUSTERED) gather(min(pixel, pc.pixels - 1u), pixel < pc.pixels);
  if (pixel >= pc.pixels) return;
  if (!PACKED && !CLUSTERED) unpack(pixel);
  uint blocked = 0u;
  float seen = 0.0;
  for (uint k = 0u; k < pc.mask_words; k++) {
    uint i = pixel * pc.mask_words + k, w = pc.masks.at[i] & owned(k);
    if (PACKED) pc.masks.at[i] = w;
    blocked += uint(bitCount(w));
    if (WEIGHTED)
      for (uint b = 0u; b < 32u; b++)
        if (32u * k + b < SAMPLES && (w >> b & 1u) == 0u) seen += pc.weights.at[32u * k + b];
  }
  pc.visibility.at[pixel] = WEIGHTED ? seen : float(SAMPLES - blocked) / float(SAMPLES);
}
