// An occluder's vertex, flattened onto the receiving plane. What lies behind the plane or beyond the light is clipped:
// it would cast where there is no shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gpu/shaders/common.glsl"
#include "techniques/planar_shadow/shaders/shared.h"
layout(location = 0) in vec3 position;
layout(push_constant, scalar) uniform Push { FlattenPush push; };
out float gl_ClipDistance[2];

void main() {
  const vec4 clip = push.clip_from_world * vec4(position, 1.0);
  const float height = dot(push.plane, vec4(position, 1.0));
  gl_Position = vec4(clip.xy, 0.0, clip.w);
  gl_ClipDistance[0] = height - push.lowest;
  gl_ClipDistance[1] = push.highest > 0 ? push.highest - height : 1.0;
}
