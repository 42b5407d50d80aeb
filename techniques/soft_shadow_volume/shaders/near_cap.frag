// A ray from the eye to P that passes such a caster leaves the volume behind it, or enters it; but for the caster that P
// lies on.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
layout(push_constant, scalar) uniform Push { DrawPush push; };
layout(set = 0, binding = 0) uniform sampler2D position;
layout(location = 0) flat in vec3 corner;
layout(location = 1) flat in vec3 normal;
layout(location = 2) flat in uint triangle;
layout(location = 0) out vec2 sum;

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const vec3 p = texelFetch(position, pixel, 0).xyz;
  const bool own = push.seen.at[uint(pixel.y) * push.width + uint(pixel.x)] == triangle;
  const bool behind = dot(normal, p - corner) < 0.0;
  sum = vec2(!own && behind == gl_FrontFacing ? (behind ? -1.0 : 1.0) : 0.0, 0.0);
}
