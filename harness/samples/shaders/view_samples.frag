#version 460
layout(location = 0) out uint triangle;
void main() { triangle = uint(gl_PrimitiveID); }
