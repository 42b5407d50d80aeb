// One level of the mip chain from the one before: each texel the mean of what it covers there. Sizes that are not
// even are halved rounding down; texels then cover more than two, the outer ones in part.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(local_size_x = SHADOW_MAP_GROUP) in;
layout(constant_id = 0) const int map_size = 1024;
layout(push_constant, scalar) uniform Push { MomentsPush push; };
#include "techniques/common/shadow_maps/shaders/moments.glsl"

// The part of [i, i + 1) that lies in [lo, hi).
float covered(int i, float lo, float hi) { return max(min(hi, float(i + 1)) - max(lo, float(i)), 0.0); }

void main() {
  const int level = int(push.level);
  const uint size = level_size(level), finer = level_size(level - 1);
  const uint i = linear_invocation();
  if (i >= size * size) return;
  const float ratio = float(finer) / float(size);
  const vec2 lo = vec2(i % size, i / size) * ratio, hi = lo + ratio;
  const uint layer = push.layer * layer_texels, from = layer + level_start(level - 1);
  vec4 sum = vec4(0);
  for (int y = int(lo.y); y < int(ceil(hi.y)); ++y)
    for (int x = int(lo.x); x < int(ceil(hi.x)); ++x) {
      const float weight = covered(x, lo.x, hi.x) * covered(y, lo.y, hi.y);
      const uvec2 at = min(uvec2(x, y), uvec2(finer - 1));
      sum += weight * stored_moments(push.from, from + at.y * finer + at.x);
    }
  store_as_stored(push.to, layer + level_start(level) + i, sum / (ratio * ratio));
}
