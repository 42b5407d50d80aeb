// The depth pass: nothing but the depth that the rasteriser makes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/common/shadow_maps/shaders/buffers.glsl"

layout(location = 0) in vec3 position;
layout(push_constant, scalar) uniform Push { DepthPush push; };

void main() { gl_Position = push.clip_from_world * vec4(position, 1); }
