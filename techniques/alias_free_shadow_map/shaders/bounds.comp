// Bounds of the view samples that face the light. GATHER: their box, while they are written as all later kernels read them;
// else: what they cover of a face.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool GATHER = false;
layout(constant_id = 4) const bool OFFSET = false;   // shadow segments begin at P', not at P
layout(push_constant, scalar) uniform Push { BoundsPush push; };

shared vec3 group_lo[group_lanes];
shared vec3 group_hi[group_lanes];

// P' lies on the light's side of its own triangle, which cannot hide it: that may be left out at either origin.
uvec4 gathered(uint pixel, vec4 light, vec4 emission) {
  const vec4 position = push.position.at[pixel];
  const bool listed = position.w > 0.0 && may_be_lit(position.xyz, push.normal.at[pixel].xyz, light, emission);
  const uint own = listed ? push.triangle.at[pixel] : not_listed;
  vec3 from = position.xyz;
  if (OFFSET) from = push.origin.at[pixel].xyz;
  return uvec4(floatBitsToUint(from), own);
}

void main() {
  const float infinity = uintBitsToFloat(0x7f800000u);
  const uint lane = gl_LocalInvocationIndex;
  const bool cube = push.frame.f.face_count > 1u;
  const vec4 light = push.frame.f.light, emission = push.frame.f.emission;
  const vec3 center = push.frame.f.center.xyz;
  const Face face = push.frame.f.faces[push.face];
  vec3 lo = vec3(infinity), hi = vec3(-infinity);
  bool outside = false;
  const uint first = linear_group() * group_lanes * samples_per_lane + lane;
  for (uint i = 0u; i < samples_per_lane; ++i) {
    const uint pixel = first + i * group_lanes;
    if (pixel >= push.count) break;
    uvec4 s;
    if (GATHER) {
      s = gathered(pixel, light, emission);
      push.samples.at[pixel] = s;
    } else {
      s = push.samples.at[pixel];
    }
    bool counts = s.w != not_listed;
    vec3 p = uintBitsToFloat(s.xyz);
    if (!GATHER) {
      const vec3 q = p - center;
      p = project(face, q);
      counts = counts && (!cube || cube_face(q) == push.face);
      const bool inside = (PARALLEL || p.z > 0.0) && abs(p.x) <= push.limit && abs(p.y) <= push.limit;
      outside = outside || (counts && !inside);
      counts = counts && inside;
    }
    lo = counts ? min(lo, p) : lo;
    hi = counts ? max(hi, p) : hi;
  }
  if (outside) push.bounds.at[push.face].outside = 0u;
  group_lo[lane] = lo;
  group_hi[lane] = hi;
  for (uint width = group_lanes / 2u; width > 0u; width /= 2u) {
    barrier();
    if (lane < width) {
      group_lo[lane] = min(group_lo[lane], group_lo[lane + width]);
      group_hi[lane] = max(group_hi[lane], group_hi[lane + width]);
    }
  }
  if (lane == 0u && group_lo[0].x <= group_hi[0].x)
    for (int c = 0; c < 3; ++c) {
      atomicMin(push.bounds.at[push.face].lo[c], ordered(group_lo[0][c]));
      atomicMin(push.bounds.at[push.face].hi[c], ~ordered(group_hi[0][c]));
    }
}
