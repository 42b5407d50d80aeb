// From depths to moments, texel by texel; depth is linear over the layer's range.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(local_size_x = SHADOW_MAP_GROUP) in;
layout(constant_id = 0) const int map_size = 1024;
layout(push_constant, scalar) uniform Push { MomentsPush push; };
#include "techniques/common/shadow_maps/shaders/depth_map.glsl"
#include "techniques/common/shadow_maps/shaders/moments.glsl"

void main() {
  const uint i = linear_invocation();
  if (i >= map_size * map_size) return;
  const MapLayer layer = push.layers.at[push.layer];
  const ivec2 texel = ivec2(i % map_size, i / map_size);
  const float linear = linear_depth(layer, vec2(texel) + 0.5, depth_at(texel, push.layer));
  const float depth = clamp((linear - layer.range.z) / (layer.range.w - layer.range.z), 0, 1);
  store_moments(push.to, push.layer * layer_texels + i, moments_of(depth));
}
