#version 460
layout(location = 0) in vec3 position;
layout(push_constant) uniform Push { mat4 clip_from_world; } pc;
void main() { gl_Position = pc.clip_from_world * vec4(position, 1.0); }
