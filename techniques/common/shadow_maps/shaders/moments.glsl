// Moments of one texel in a buffer: what vsm, evsm and msm store, as floats or in 16 bits each.
#include "techniques/common/shadow_maps/shaders/moment_filters.h"

const int vsm = 2, evsm = 3, msm = 4;   // as params.h
layout(constant_id = 10) const int filter_kind = 2;
layout(constant_id = 11) const bool sixteen_bits = false;
layout(constant_id = 12) const float positive_exponent = 40;
layout(constant_id = 13) const float negative_exponent = 5;
layout(constant_id = 14) const uint layer_texels = 1024 * 1024;   // all levels of a layer
layout(constant_id = 15) const int levels = 1;

// Levels of a layer's mip chain lie one behind the other, each half as wide (rounded down), down to one texel.
uint level_size(int level) { return max(uint(map_size) >> level, 1u); }

uint level_start(int level) {
  uint start = 0;
  for (int l = 0; l < level; ++l) start += level_size(l) * level_size(l);
  return start;
}

const uint moment_count = filter_kind == vsm ? 2 : 4;
const uint moment_words = sixteen_bits ? moment_count / 2 : moment_count;

// The optimised quantisation of [Peters2015]: an affine map that spreads the moments over [0, 1].
const mat4 quantise = mat4(-2.07224649, 13.7948857237, 0.105877704, 9.7924062118,
                           32.23703778, -59.4683975703, -1.9077466311, -33.7652110555,
                           -68.571074599, 82.0359750338, 9.3496555107, 47.9456096605,
                           39.3703274134, -35.364903257, -6.6543490743, -23.9728048165);
const mat4 restore = mat4(0.2227744146, 0.1549679261, 0.1451988946, 0.163127443,
                          0.0771972861, 0.1394629426, 0.2120202157, 0.2591432266,
                          0.7926986636, 0.7963415838, 0.7258694464, 0.6539092497,
                          0.0319417555, -0.1722823173, -0.2758014811, -0.3376131734);
const vec4 quantise_offset = vec4(0.035955884801, 0, 0, 0);

vec4 moments_of(float depth) {
  if (filter_kind == vsm) return vec4(depth, depth * depth, 0, 0);
  if (filter_kind == evsm) {
    const float p = warp_positive(depth, positive_exponent), n = warp_negative(depth, negative_exponent);
    return vec4(p, p * p, n, n * n);
  }
  const float square = depth * depth;
  return vec4(depth, square, square * depth, square * square);
}

void store_moments(UintArray to, uint texel, vec4 m) {
  const uint at = texel * moment_words;
  if (!sixteen_bits) {
    for (int i = 0; i < moment_count; ++i) to.at[at + i] = floatBitsToUint(m[i]);
    return;
  }
  if (filter_kind == msm) {
    m = quantise * m + quantise_offset;
    to.at[at] = packUnorm2x16(m.xy);
    to.at[at + 1] = packUnorm2x16(m.zw);
    return;
  }
  to.at[at] = packHalf2x16(m.xy);
  if (filter_kind == evsm) to.at[at + 1] = packHalf2x16(m.zw);
}

// As stored: quantised moments stay quantised, for they are blurred and interpolated as they are.
vec4 stored_moments(UintArray from, uint texel) {
  const uint at = texel * moment_words;
  vec4 m = vec4(0);
  if (!sixteen_bits) {
    for (int i = 0; i < moment_count; ++i) m[i] = uintBitsToFloat(from.at[at + i]);
    return m;
  }
  if (filter_kind == msm) return vec4(unpackUnorm2x16(from.at[at]), unpackUnorm2x16(from.at[at + 1]));
  m.xy = unpackHalf2x16(from.at[at]);
  if (filter_kind == evsm) m.zw = unpackHalf2x16(from.at[at + 1]);
  return m;
}

void store_as_stored(UintArray to, uint texel, vec4 m) {
  if (sixteen_bits && filter_kind == msm) {
    to.at[texel * moment_words] = packUnorm2x16(m.xy);
    to.at[texel * moment_words + 1] = packUnorm2x16(m.zw);
  } else {
    store_moments(to, texel, m);
  }
}

vec4 moments_from_stored(vec4 m) {
  return sixteen_bits && filter_kind == msm ? restore * (m - quantise_offset) : m;
}
