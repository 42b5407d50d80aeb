// Visibility of one light, or of one part of a split light: what is above the horizon less what the sums say is
// covered. Overlapping casters count twice, so the sum may exceed the light.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
const bool HORIZON = true;
#include "techniques/soft_shadow_volume/shaders/coverage.glsl"
layout(local_size_x = WEDGE_GROUP) in;
layout(constant_id = 0) const uint SHAPE = SHAPE_RECTANGLE;
layout(push_constant, scalar) uniform Push { ResolvePush push; };

layout(set = 0, binding = 0) uniform sampler2D weights;

const bool disc = SHAPE == SHAPE_DISC;

#include "techniques/soft_shadow_volume/shaders/texture.glsl"

float light_above(View v) {
  if (SHAPE != SHAPE_TEXTURE) return area_above(v, disc);
  first_row = int(push.light.scale_u.w), texture_rows = int(push.light.scale_v.w);
  return textured_above(v);
}

float lit_share(vec3 p, vec3 n, vec2 sums) {
  const float volumes = sums.x + float(push.extraction.at.eye_count);
  if (SHAPE == SHAPE_POINT) return volumes == 0.0 && dot(n, push.light.center.xyz - p) > 0.0 ? 1.0 : 0.0;
  if (!disc && dot(cross(push.light.scale_u.xyz, push.light.scale_v.xyz), p - push.light.center.xyz) <= 0.0) return 0.0;
  const View v = view_of(p, n, push.light, disc);
  const float above = light_above(v), all = disc ? pi : 4.0;
  return clamp(above - volumes * above - sums.y, 0.0, above) / all;
}

void main() {
  const uint pixel = linear_invocation();
  if (pixel >= push.count) return;
  const vec4 position = push.position.at[pixel];  // w: depth, 0 where nothing is seen
  const float lit = position.w == 0.0 ? 1.0 : lit_share(position.xyz, push.normal.at[pixel].xyz, push.sums.at[pixel]);
  const float before = push.first != 0 ? 0.0 : push.visibility.at[pixel];
  push.visibility.at[pixel] = before + push.share * lit;
}
