// The depth pass of logarithmic maps. Their straight lines are curves, which no rasteriser draws: each triangle is drawn
// as the rectangle around its image, and log_depth.frag decides texel by texel [Lloyd2008].
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(constant_id = 0) const int caster_faces = 0;   // 0 both, 1 front, 2 back, as params.h
layout(push_constant, scalar) uniform Push { LogDepthPush push; };
layout(location = 0) flat out vec4 corner0;
layout(location = 1) flat out vec4 corner1;
layout(location = 2) flat out vec4 corner2;

vec4 corner(uint i) {
  return push.clip_from_world * vec4(push.positions.at[push.indices.at[3 * (gl_VertexIndex / 6) + i]], 1);
}

bool in_front(vec4 p) { return p.w > 0 && p.y < 0; }

vec2 image(vec4 p) { return vec2(p.x / p.w, push.log_scale * log(-p.w / p.y) + push.log_offset); }

void main() {
  corner0 = corner(0), corner1 = corner(1), corner2 = corner(2);
  const vec2 margin = vec2(1.0 / push.map_size);   // half a texel
  vec2 lo = vec2(-1), hi = vec2(1);                // a triangle that reaches behind the centre may be anywhere
  const bool a = in_front(corner0), b = in_front(corner1), c = in_front(corner2);
  if (a && b && c) {
    const vec2 p = image(corner0), q = image(corner1), r = image(corner2);
    lo = clamp(min(p, min(q, r)) - margin, -1, 1);
    hi = clamp(max(p, max(q, r)) + margin, -1, 1);
  }
  // Negative: counter-clockwise seen from the light (y points down).
  const float turn = dot(corner0.xyw, cross(corner1.xyw, corner2.xyw));
  const bool culled = caster_faces == 1 ? turn >= 0 : caster_faces == 2 ? turn <= 0 : false;
  const bool behind = max(corner0.w, max(corner1.w, corner2.w)) <= 0 || min(corner0.y, min(corner1.y, corner2.y)) >= 0;
  if (culled || behind) hi = lo;
  const uint i = gl_VertexIndex % 6;
  gl_Position = vec4(i == 1 || i == 2 || i == 4 ? hi.x : lo.x, i == 2 || i == 4 || i == 5 ? hi.y : lo.y, 0.5, 1);
}
