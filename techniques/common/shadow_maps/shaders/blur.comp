// One direction of a separable blur of moments.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(local_size_x = SHADOW_MAP_GROUP) in;
layout(constant_id = 0) const int map_size = 1024;
layout(constant_id = 1) const int taps = 5;
layout(constant_id = 2) const bool gaussian = false;
layout(constant_id = 3) const bool vertical = false;
layout(push_constant, scalar) uniform Push { MomentsPush push; };
#include "techniques/common/shadow_maps/shaders/moments.glsl"

void main() {
  const uint i = linear_invocation();
  if (i >= map_size * map_size) return;
  const ivec2 texel = ivec2(i % map_size, i / map_size);
  vec4 sum = vec4(0);
  float weights = 0;
  for (int t = 0; t < taps; ++t) {
    // An even number of taps is centred half a texel off.
    const int offset = t - taps / 2;
    const ivec2 at = clamp(texel + (vertical ? ivec2(0, offset) : ivec2(offset, 0)), ivec2(0), ivec2(map_size - 1));
    const float x = (float(t) - 0.5 * float(taps - 1)) / (0.25 * float(taps));
    const float weight = gaussian ? exp(-0.5 * x * x) : 1.0;
    sum += weight * stored_moments(push.from, push.layer * layer_texels + at.y * map_size + at.x);
    weights += weight;
  }
  store_as_stored(push.to, push.layer * layer_texels + i, sum / weights);
}
