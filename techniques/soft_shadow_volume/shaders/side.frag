// A ray from the eye to P that passes a side enters a volume, or leaves it. Which side of the plane the eye is on comes
// from the picture, where neighbouring sides meet without a gap; which side P is on, from P itself: no depth is
// compared.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
#include "techniques/soft_shadow_volume/shaders/side.glsl"
layout(push_constant, scalar) uniform Push { DrawPush push; };
layout(set = 0, binding = 0) uniform sampler2D position;
layout(location = 0) flat in vec4 edge_a;
layout(location = 1) flat in vec3 edge_b;
layout(location = 0) out vec2 sum;

void main() {
  const vec3 p = texelFetch(position, ivec2(gl_FragCoord.xy), 0).xyz;
  const bool inside = side_of(p, edge_a.xyz, edge_b, push.center.xyz) >= 0.0;
  sum = vec2(inside == gl_FrontFacing ? (inside ? edge_a.w : -edge_a.w) : 0.0, 0.0);
}
