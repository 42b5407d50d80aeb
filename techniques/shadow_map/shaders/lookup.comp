// The lookup: visibility of each view sample from the depth maps, by percentage-closer filtering [Reeves 1987].
// A kernel of one texel is Williams' comparison with the nearest texel [Williams 1978].
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/shadow_map/shaders/buffers.glsl"

layout(local_size_x = SHADOW_MAP_GROUP) in;
layout(constant_id = 0) const int map_size = 1024;
layout(constant_id = 1) const bool faces = false;
layout(constant_id = 2) const int kernel = 3;
layout(constant_id = 3) const int disc_samples = 0;   // 0: the grid of kernel x kernel texels
layout(constant_id = 4) const bool disc_rotation = false;
layout(constant_id = 5) const bool receiver_plane = false;
layout(push_constant, scalar) uniform Push { LookupPush push; };
layout(set = 0, binding = 0) uniform sampler2DArray depth_map;

#include "techniques/shadow_map/shaders/layer.glsl"

// 1 where the receiver is not behind the texel's depth.
float tap(const Receiver r, vec2 offset) {
  const vec2 texel = floor(r.texel + offset);
  const float depth = receiver_plane ? r.depth + dot(r.slope, texel + 0.5 - r.texel) : r.depth;
  return depth <= depth_at(ivec2(texel), r.layer) ? 1.0 : 0.0;
}

float grid_filter(const Receiver r) {
  const float first = -0.5 * float(kernel - 1);
  float lit = 0;
  for (int y = 0; y < kernel; ++y)
    for (int x = 0; x < kernel; ++x) lit += tap(r, vec2(x, y) + first);
  return lit / float(kernel * kernel);
}

// A pixel's own angle, well spread over neighbouring pixels.
float pixel_angle(uint pixel) {
  uint h = pixel * 0x9e3779b9u;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return float(h >> 8) * (6.2831853 / 16777216.0);
}

float disc_filter(const Receiver r, uint pixel) {
  mat2 turn = mat2(1, 0, 0, 1);
  if (disc_rotation) {
    const float a = pixel_angle(pixel);
    turn = mat2(cos(a), sin(a), -sin(a), cos(a));
  }
  float lit = 0;
  for (int i = 0; i < disc_samples; ++i) lit += tap(r, turn * push.disc.at[i] * (0.5 * float(kernel)));
  return lit / float(disc_samples);
}

void main() {
  const uint pixel = linear_group() * SHADOW_MAP_GROUP + gl_LocalInvocationIndex;
  if (pixel >= push.count) return;
  const vec4 position = push.position.at[pixel];
  const vec3 origin = push.origin.at[pixel].xyz, normal = push.normal.at[pixel].xyz;
  const vec3 to_light = push.light.xyz - push.light.w * origin;
  float visibility = 0;
  if (position.w > 0 && may_be_lit(position.xyz, normal, push.light, push.emission)) {
    const uint layer = layer_of(position.w, -to_light);
    const Receiver r = locate(layer, origin + push.constant_bias * normalize(to_light), normal);
    visibility = disc_samples > 0 ? disc_filter(r, pixel) : grid_filter(r);
  }
  push.visibility.at[pixel] = visibility;
}
