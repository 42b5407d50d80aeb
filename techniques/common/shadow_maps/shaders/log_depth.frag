// One texel of a logarithmic map: is its centre, unwarped, in the triangle, and how deep is the triangle there?
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(push_constant, scalar) uniform Push { LogDepthPush push; };
layout(location = 0) flat in vec4 corner0;
layout(location = 1) flat in vec4 corner1;
layout(location = 2) flat in vec4 corner2;

// Homogeneous edge functions [Olano and Greer 1997]: weights of the corners at a point of the unwarped map.
vec3 weights(vec2 texel) {
  const vec2 m = texel * (2.0 / push.map_size) - 1;
  const vec3 q = vec3(m.x, -exp((push.log_offset - m.y) / push.log_scale), 1);
  return vec3(dot(cross(corner1.xyw, corner2.xyw), q), dot(cross(corner2.xyw, corner0.xyw), q),
              dot(cross(corner0.xyw, corner1.xyw), q));
}

float depth_of(vec3 e) {
  return dot(e, vec3(corner0.z, corner1.z, corner2.z)) / dot(e, vec3(corner0.w, corner1.w, corner2.w));
}

void main() {
  const vec3 e = weights(gl_FragCoord.xy);
  const bool inside = (e.x >= 0 && e.y >= 0 && e.z >= 0) || (e.x <= 0 && e.y <= 0 && e.z <= 0);
  const float w = dot(e, vec3(corner0.w, corner1.w, corner2.w)) / (e.x + e.y + e.z);
  if (!inside || !(w > 0)) discard;
  const float depth = depth_of(e);
  // The rasteriser's slope-scaled bias, of the triangle's plane.
  const float slope = max(abs(depth_of(weights(gl_FragCoord.xy + vec2(1, 0))) - depth),
                          abs(depth_of(weights(gl_FragCoord.xy + vec2(0, 1))) - depth));
  gl_FragDepth = clamp(depth + push.slope_bias * slope, 0, 1);
}
