// What an edge adds to the coverage of the light at a view sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
#include "techniques/soft_shadow_volume/shaders/side.glsl"
layout(constant_id = 3) const bool HORIZON = true;  // for view samples whose horizon cuts the light; else for those
                                                    // that have all of it above
#include "techniques/soft_shadow_volume/shaders/coverage.glsl"
layout(constant_id = 0) const uint SHAPE = SHAPE_RECTANGLE;
layout(constant_id = 1) const bool TABLE = false;
layout(constant_id = 2) const bool COUNT = false;  // for the statistics alone
layout(push_constant, scalar) uniform Push { WedgePush push; };
layout(set = 0, binding = 0) uniform sampler2D position;
layout(set = 0, binding = 1) uniform sampler2D normal;
layout(set = 0, binding = 2) uniform sampler2D angles;
layout(set = 0, binding = 3) uniform sampler2D areas;
layout(set = 0, binding = 4) uniform sampler2D weights;
layout(location = 0) flat in vec4 edge_a;
layout(location = 1) flat in vec3 edge_b;
layout(location = 0) out vec2 sum;

const bool disc = SHAPE == SHAPE_DISC;

#include "techniques/soft_shadow_volume/shaders/table.glsl"
#include "techniques/soft_shadow_volume/shaders/texture.glsl"

void main() {
  const ivec2 pixel = ivec2(gl_FragCoord.xy);
  const vec3 p = texelFetch(position, pixel, 0).xyz;
  const vec4 classed = texelFetch(normal, pixel, 0);
  const bool here = uint(classed.w) == (HORIZON ? CLASS_CUT : CLASS_WHOLE);
  AreaLight light = AreaLight(push.pivot, push.scale_u, push.scale_v);
  light.center.xyz -= pivot_offset(light, disc);
  const View v = view_of(p, classed.xyz, light, disc);
  const vec3 a = project(v, edge_a.xyz), b = project(v, edge_b);
  vec2 from, to;
  const bool meets = disc ? clip_to_disc(a, b, from, to) : clip_to_rectangle(a, b, from, to);
  if (COUNT) {
    sum = here ? vec2(1.0, meets ? 1.0 : 0.0) : vec2(0.0);
    return;
  }
  const bool left = side_of(p, edge_a.xyz, edge_b, push.pivot.xyz) >= 0.0;
  float beyond;
  if (SHAPE == SHAPE_TEXTURE) {
    first_row = int(push.scale_u.w), texture_rows = int(push.scale_v.w);
    beyond = textured_beyond(v, from, to, left);
  } else if (TABLE && !HORIZON) {
    beyond = triangle_area(v, from, to) - sector_by_table(from, to, left);
  } else {
    beyond = triangle_area(v, from, to) - sector_area(v, from, to, left, disc);
  }
  sum = vec2(0.0, here && meets ? edge_a.w * beyond : 0.0);
}
