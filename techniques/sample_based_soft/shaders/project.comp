// View samples in the light's view, and the bounds of what they cover there [Sintorn2008, sec. 3.1, 4.3].
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/sample_based_soft/shaders/frame.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
#include "techniques/common/shaders/subgroup.glsl"
layout(set = 0, binding = 0) uniform sampler2D frame_texels;
layout(push_constant) uniform Push { SamplesConstants pc; };

void main() {
  FrameConstants f;
  f.light = light_basis(frame_texels);
  f.eye = texel(frame_texels, eye_texel);
  vec4 limits = texel(frame_texels, pad_texel);
  f.near = limits.y;
  f.widest = limits.z;
  vec2 lo = vec2(1e30), hi = vec2(-1e30);
  float farthest = -1e30;
  uint first = linear_group() * SG * pixels_per_lane + gl_SubgroupInvocationID;
  for (uint k = 0u; k < pixels_per_lane; k++) {
    uint i = first + k * SG, pixel = min(i, pc.pixels - 1u);
    vec4 o = pc.origin.at[pixel];
    bool lit = i < pc.pixels && reachable(f.light, o, pc.normal.at[pixel].xyz, pc.slack);
    vec3 q = to_working(f.light, o.xyz) - f.eye.xyz;
    bool inside = lit && q.z > f.near;
    vec2 uv = q.xy / (inside ? q.z : 1.0);
    bool counts = inside && abs(uv.x) <= f.widest && abs(uv.y) <= f.widest;
    lo = counts && uv.x < lo.x ? vec2(uv.x, lo.y) : lo;
    lo = counts && uv.y < lo.y ? vec2(lo.x, uv.y) : lo;
    hi = counts && uv.x > hi.x ? vec2(uv.x, hi.y) : hi;
    hi = counts && uv.y > hi.y ? vec2(hi.x, uv.y) : hi;
    farthest = inside && q.z > farthest ? q.z : farthest;
    if (i < pc.pixels) pc.places.at[pixel] = vec4(uv, q.z, inside ? 1.0 : lit ? 2.0 : 0.0);
  }
  float lo_u = lowest(lo.x), lo_v = lowest(lo.y), hi_u = highest(hi.x), hi_v = highest(hi.y), z = highest(farthest);
  if (gl_SubgroupInvocationID != 0u) return;
  if (lo_u <= hi_u) {
    atomicMin(pc.header.h.lo[0], ordered(lo_u));
    atomicMin(pc.header.h.lo[1], ordered(lo_v));
    atomicMin(pc.header.h.hi[0], ~ordered(hi_u));
    atomicMin(pc.header.h.hi[1], ~ordered(hi_v));
  }
  if (z > 0.0) atomicMin(pc.header.h.farthest, ~ordered(z));
}
