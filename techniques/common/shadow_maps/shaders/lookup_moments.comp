// The lookup in filterable maps: variance [Donnelly2006], exponential variance [Lauritzen2008] and moment shadow
// maps [Peters2015], interpolated between texels.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(local_size_x = SHADOW_MAP_GROUP) in;
layout(constant_id = 0) const int map_size = 1024;
layout(constant_id = 1) const bool faces = false;
layout(push_constant, scalar) uniform Push { LookupPush push; };
#include "techniques/common/shadow_maps/shaders/moments.glsl"
#include "techniques/common/shadow_maps/shaders/layer.glsl"

// Between the four texels of a level around a place, which is given in texels of the finest.
vec4 bilinear(uint layer, int level, vec2 texel) {
  const uint start = layer * layer_texels + level_start(level);
  const int size = int(level_size(level));
  const vec2 place = texel * (float(size) / float(map_size)) - 0.5;
  const vec2 corner = floor(place), part = place - corner;
  vec4 sum = vec4(0);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      const ivec2 at = clamp(ivec2(corner) + ivec2(x, y), ivec2(0), ivec2(size - 1));
      const float weight = (x == 0 ? 1 - part.x : part.x) * (y == 0 ? 1 - part.y : part.y);
      sum += weight * stored_moments(push.moments, start + at.y * size + at.x);
    }
  return sum;
}

vec4 trilinear(uint layer, float detail, vec2 texel) {
  const float held = clamp(detail, 0, float(levels - 1));
  const int level = int(held);
  const vec4 finer = bilinear(layer, level, texel);
  return held > float(level) ? mix(finer, bilinear(layer, level + 1, texel), held - float(level)) : finer;
}

// Probes along the footprint's longer axis, each as wide as the shorter one: as Vulkan describes anisotropic filtering.
vec4 filtered(const Receiver r, vec3 point, vec3 normal, float view_depth) {
  if (levels == 1) return moments_from_stored(bilinear(r.layer, 0, r.texel));
  const mat2 pixel = footprint(r.layer, point, normal, view_depth);
  const float a = length(pixel[0]), b = length(pixel[1]);
  const float longer = max(a, b), shorter = max(min(a, b), 1e-6);
  const float probes = clamp(ceil(longer / shorter), 1, float(push.max_probes));
  const float detail = log2(max(longer, 1e-6) / probes);
  const vec2 axis = a > b ? pixel[0] : pixel[1];
  vec4 sum = vec4(0);
  for (float i = 1; i <= probes; ++i) sum += trilinear(r.layer, detail, r.texel + axis * (i / (probes + 1) - 0.5));
  return moments_from_stored(sum / probes);
}

float bound(vec4 m, float depth) {
  if (filter_kind == vsm) return chebyshev(m.x, m.y, depth, push.variance_or_bias);
  if (filter_kind == msm) return four_moments(m.x, m.y, m.z, m.w, depth, push.variance_or_bias);
  const float p = warp_positive(depth, positive_exponent), n = warp_negative(depth, negative_exponent);
  return min(chebyshev(m.x, m.y, p, warped_variance(p, positive_exponent, push.variance_or_bias)),
             chebyshev(m.z, m.w, n, warped_variance(n, negative_exponent, push.variance_or_bias)));
}

void main() {
  const uint pixel = linear_invocation();
  if (pixel >= push.count) return;
  const vec4 position = push.position.at[pixel];
  const vec3 origin = push.origin.at[pixel].xyz, normal = push.normal.at[pixel].xyz;
  const vec3 to_light = push.light.xyz - push.light.w * origin;
  float visibility = 0;
  if (position.w > 0 && may_be_lit(position.xyz, normal, push.light, push.emission)) {
    const uint layer = layer_of(position.w, -to_light);
    const Receiver r = locate(layer, origin + push.constant_bias * normalize(to_light), normal);
    const vec2 range = push.layers.at[layer].range.zw;
    const float depth = clamp((r.linear - range.x) / (range.y - range.x), 0, 1);
    visibility = reduce_bleeding(bound(filtered(r, position.xyz, normal, position.w), depth), push.bleeding_reduction);
  }
  push.visibility.at[pixel] = visibility;
}
