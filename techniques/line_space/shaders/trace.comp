// One invocation follows the shadow segments of a pixel to up to 32 light samples, the bits of one word of its mask.
// IMAGES: the pools are read from images, else by address.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/line_space/shaders/buffers.glsl"
#include "techniques/common/shaders/light_emission.glsl"
#include "techniques/line_space/shaders/words.glsl"
layout(constant_id = 1) const uint DEPTH = 3;
layout(constant_id = 2) const uint START = start_node;
layout(push_constant, scalar) uniform Push { TracePush push; };

#ifdef IMAGES
layout(set = 0, binding = 0) uniform usampler2D tree_image;
layout(set = 0, binding = 1) uniform usampler2D line_space_image;
uint tree_entry(uint place) { return fetch_word(tree_image, place); }
uint line_space_word(uint place) { return fetch_word(line_space_image, place); }
#else
uint tree_entry(uint place) { return push.tree_pool.at[place]; }
uint line_space_word(uint place) { return push.line_space_pool.at[place]; }
#endif
#define VEC3 vec3
#include "techniques/line_space/shaders/traverse.glsl"

void main() {
  const uint tiles = (push.width + tile_side - 1u) / tile_side, tile = linear_group();
  const uint lane = gl_LocalInvocationID.x;
  // Eight lanes, where that is a subgroup, are 4 x 2 pixels.
  const uint px = tile % tiles * tile_side + (lane & 3u) + (lane >> 1u & 4u), py = tile / tiles * tile_side + (lane >> 2u & 1u) + (lane >> 3u & 6u);
  if (px >= push.width || py >= push.height) return;
  const uint pixel = py * push.width + px, word = pixel * push.words + (push.first >> 5u);
  const bool first_of_word = (push.first & 31u) == 0u;
  if (push.triangle.at[pixel] == 0xffffffffu) {
    if (first_of_word) push.mask.at[word] = 0u;
    return;
  }
  const TraceConstants c = push.constants.values;
  const vec3 p = push.position.at[pixel].xyz, n = push.normal.at[pixel].xyz, from = push.origin.at[pixel].xyz;
  const vec3 o = (from - c.lo.xyz) * c.scale.xyz;
  uint blocked = first_of_word ? 0u : push.mask.at[word];
  for (uint i = push.first; i < push.end; ++i) {
    const vec4 light = push.points.at[i];
    bool dark = !may_be_lit(p, n, light, c.emission);
    if (!dark) {
      const vec3 d = (light.xyz - from * light.w) * c.scale.xyz;
      Walk w = begin_walk(o, d, light.w > 0.5 ? 1.000001 : far_away);
      while (!w.done) w = step_walk(w);
      dark = w.blocked;
    }
    blocked |= dark ? 1u << (i & 31u) : 0u;
  }
  push.mask.at[word] = blocked;
}
