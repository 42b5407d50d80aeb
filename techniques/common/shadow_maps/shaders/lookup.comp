// The lookup: visibility of each view sample from the depth maps, by percentage-closer filtering [Reeves1987].
// A kernel of one texel is Williams' comparison with the nearest texel. With `soft`, the kernel's size follows from the
// blockers' mean depth: percentage-closer soft shadows [Fernando2005].
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(local_size_x = SHADOW_MAP_GROUP) in;
layout(constant_id = 0) const int map_size = 1024;
layout(constant_id = 1) const bool faces = false;
layout(constant_id = 2) const int kernel = 3;
layout(constant_id = 3) const int disc_samples = 0;   // 0: the grid of kernel x kernel texels
layout(constant_id = 4) const bool disc_rotation = false;
layout(constant_id = 5) const bool receiver_plane = false;
layout(constant_id = 6) const int search = 0;         // blocker search of search x search taps; 0: the kernel's size is fixed
layout(constant_id = 7) const bool round_light = false;
layout(constant_id = 8) const float border = 0;       // texels that search and filter may reach
layout(push_constant, scalar) uniform Push { LookupPush push; };

#include "techniques/common/shadow_maps/shaders/depth_map.glsl"
#include "techniques/common/shadow_maps/shaders/layer.glsl"

struct Tap {
  vec2 texel;
  float stored;
  float lit;   // 1 where the receiver is not behind the texel's depth
};

Tap tap(const Receiver r, vec2 offset) {
  const vec2 texel = floor(r.texel + offset);
  const float depth = receiver_plane ? r.depth + dot(r.slope, texel + 0.5 - r.texel) : r.depth;
  const float stored = depth_at(ivec2(texel), r.layer);
  return Tap(texel, stored, depth <= stored ? 1.0 : 0.0);
}

// A pixel's own angle, well spread over neighbouring pixels.
mat2 pixel_turn(uint pixel) {
  if (!disc_rotation) return mat2(1, 0, 0, 1);
  uint h = pixel * 0x9e3779b9u;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  const float a = float(h >> 8) * (6.2831853 / 16777216.0);
  return mat2(cos(a), sin(a), -sin(a), cos(a));
}

float grid_filter(const Receiver r) {
  const float first = -0.5 * float(kernel - 1);
  float lit = 0;
  for (int y = 0; y < kernel; ++y)
    for (int x = 0; x < kernel; ++x) lit += tap(r, vec2(x, y) + first).lit;
  return lit / float(kernel * kernel);
}

float disc_filter(const Receiver r, mat2 turn) {
  float lit = 0;
  for (int i = 0; i < disc_samples; ++i) lit += tap(r, turn * push.disc.at[i] * (0.5 * float(kernel))).lit;
  return lit / float(disc_samples);
}

// Cell centre (x, y) of an n x n grid over the light, in [-1/2, 1/2]; on a disc for round lights, area for area.
vec2 on_light(int x, int y, int n) {
  const vec2 s = (vec2(x, y) + 0.5) * (2.0 / float(n)) - 1;
  if (!round_light) return 0.5 * s;
  if (s == vec2(0)) return s;
  const bool wide = abs(s.x) > abs(s.y);
  const float radius = wide ? s.x : s.y, angle = 0.785398163 * (wide ? s.y / s.x : 2 - s.x / s.y);
  return 0.5 * radius * vec2(cos(angle), sin(angle));
}

// The map's texels that the light spans when it is `scale` large, seen from the receiver through the map's plane; held
// to the border that was fitted around the receivers.
mat2 light_in_texels(uint layer, float scale) {
  const vec4 t = push.layers.at[layer].light_texels * scale;
  const float reach = 0.5 * max(length(t.xy) + length(t.zw), 1e-6);
  const float held = min(1, border / reach);
  return mat2(t.xy * held, t.zw * held);
}

float soft_filter(const Receiver r, mat2 turn) {
  const MapLayer layer = push.layers.at[r.layer];
  const float near = linear_depth(layer, vec2(0.5 * map_size), 0);
  const mat2 region = light_in_texels(r.layer, 1 / near - 1 / r.linear);
  float blockers = 0, depths = 0;
  for (int y = 0; y < search; ++y)
    for (int x = 0; x < search; ++x) {
      const Tap t = tap(r, region * on_light(x, y, search));
      if (t.lit == 0) {
        blockers += 1;
        depths += linear_depth(layer, t.texel + 0.5, t.stored);
      }
    }
  if (blockers == 0) return 1;
  // The penumbra at the receiver, (d_receiver - d_blocker) / d_blocker lights wide, as the map sees it.
  const mat2 penumbra = light_in_texels(r.layer, max(0, blockers / depths - 1 / r.linear));
  float lit = 0;
  if (disc_samples > 0) {
    for (int i = 0; i < disc_samples; ++i) lit += tap(r, penumbra * (turn * push.disc.at[i] * 0.5)).lit;
    return lit / float(disc_samples);
  }
  for (int y = 0; y < kernel; ++y)
    for (int x = 0; x < kernel; ++x) lit += tap(r, penumbra * on_light(x, y, kernel)).lit;
  return lit / float(kernel * kernel);
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
    if (search > 0) visibility = soft_filter(r, pixel_turn(pixel));
    else if (disc_samples > 0) visibility = disc_filter(r, pixel_turn(pixel));
    else visibility = grid_filter(r);
  }
  push.visibility.at[pixel] = visibility;
}
