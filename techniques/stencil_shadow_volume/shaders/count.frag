// For the statistics alone: what a fragment adds to its pixel's count.
#version 460
layout(constant_id = 0) const float front = 1;
layout(constant_id = 1) const float back = 1;
layout(location = 0) out float value;
void main() { value = gl_FrontFacing ? front : back; }
