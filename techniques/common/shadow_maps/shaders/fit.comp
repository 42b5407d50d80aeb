// Bounds of the view samples that face the light, in any projective space.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/common/shaders/ordered_float.glsl"
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(local_size_x = SHADOW_MAP_GROUP) in;
layout(push_constant, scalar) uniform Push { FitPush push; };

const uint samples_per_thread = 16;
shared vec4 group_lo[SHADOW_MAP_GROUP];
shared vec4 group_hi[SHADOW_MAP_GROUP];

void main() {
  const FitQuery query = push.query.at[push.slot];
  const float infinity = uintBitsToFloat(0x7f800000u);
  vec4 lo = vec4(infinity), hi = vec4(-infinity);
  bool outside = false;
  const uint first = linear_group() * SHADOW_MAP_GROUP * samples_per_thread + gl_LocalInvocationIndex;
  for (uint i = 0; i < samples_per_thread; ++i) {
    const uint pixel = first + i * SHADOW_MAP_GROUP;
    if (pixel >= push.count) break;
    const vec4 position = push.position.at[pixel];
    const vec3 normal = push.normal.at[pixel].xyz;
    const vec4 clip = query.space_from_world * vec4(position.xyz, 1);
    const vec3 p = clip.xyz / clip.w;
    const bool seen = position.w > 0 && position.w >= query.range.x && position.w < query.range.y &&
                      may_be_lit(position.xyz, normal, query.light, query.emission);
    const bool inside = clip.w > 0 && abs(p.x) <= query.range.z && abs(p.y) <= query.range.z;
    outside = outside || (seen && !inside);
    if (seen && inside) {
      lo = min(lo, vec4(p, position.w));
      hi = max(hi, vec4(p, position.w));
    }
  }
  if (outside) push.bounds.at[push.slot].outside = 0;
  group_lo[gl_LocalInvocationIndex] = lo;
  group_hi[gl_LocalInvocationIndex] = hi;
  for (uint half_size = SHADOW_MAP_GROUP / 2; half_size > 0; half_size /= 2) {
    barrier();
    if (gl_LocalInvocationIndex < half_size) {
      group_lo[gl_LocalInvocationIndex] = min(group_lo[gl_LocalInvocationIndex], group_lo[gl_LocalInvocationIndex + half_size]);
      group_hi[gl_LocalInvocationIndex] = max(group_hi[gl_LocalInvocationIndex], group_hi[gl_LocalInvocationIndex + half_size]);
    }
  }
  if (gl_LocalInvocationIndex == 0 && group_lo[0].w <= group_hi[0].w)
    for (int c = 0; c < 4; ++c) {
      atomicMin(push.bounds.at[push.slot].lo[c], ordered(group_lo[0][c]));
      atomicMin(push.bounds.at[push.slot].hi[c], ~ordered(group_hi[0][c]));
    }
}
