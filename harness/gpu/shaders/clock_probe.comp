// A load of known shape for finding out whether the device's timestamps can be trusted: a chain of dependent
// multiply-adds that no compiler can shorten.
#version 460
#extension GL_EXT_buffer_reference : require
layout(local_size_x = 8) in;
layout(buffer_reference, std430) buffer Sink { float value[]; };
layout(push_constant) uniform Push { Sink sink; uint turns; uint groups; } pc;

void main() {
  float x = float(gl_GlobalInvocationID.x & 7u) * 0.125;
  for (uint i = 0u; i < pc.turns; ++i) x = x * 0.9999 + 0.0001 * float(i & 3u);
  pc.sink.value[gl_GlobalInvocationID.x & 63u] = x;
}
