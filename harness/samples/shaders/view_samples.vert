#version 460
layout(location = 0) in vec3 position;
// Techniques that compare with the view samples' depth draw the same triangles with the same expression.
invariant gl_Position;
layout(push_constant) uniform Push { mat4 clip_from_world; } pc;
void main() { gl_Position = pc.clip_from_world * vec4(position, 1.0); }
