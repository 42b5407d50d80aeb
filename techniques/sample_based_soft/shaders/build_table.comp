// The lookup table [Sintorn2008, sec. 4.2]: for planes given by two angles and a distance, the light samples on the side
// that the normal points to. Normals of one hemisphere; the opposite plane is the complement. An invocation makes one
// word: entries are taken at their cells' centres.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/buffers.glsl"
struct FrameConstants { uint unused; };
struct Header { uint unused; };
layout(buffer_reference) buffer FrameRef { FrameConstants f; };
layout(buffer_reference) buffer HeaderRef { Header h; };
#include "techniques/sample_based_soft/shaders/constants.h"
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { TableConstants pc; };

void main() {
  uint i = linear_invocation(), entry = i / pc.words, word = i % pc.words;
  if (entry >= pc.entries) return;
  uint e = pc.first_entry + entry;
  vec3 at = (vec3(e % pc.size, e / pc.size % pc.size, e / pc.size / pc.size) + 0.5) / float(pc.size);
  float azimuth = (at.x - 0.5) * 6.28318531, polar = at.y * 1.57079633, distance_ = (2.0 * at.z - 1.0) * pc.radius;
  vec3 n = vec3(sin(polar) * cos(azimuth), sin(polar) * sin(azimuth), cos(polar));
  uint bits = 0u;
  for (uint k = 0u; k < 32u; k++) {
    uint s = 32u * word + k;
    bool behind = dot(n, pc.samples.at[min(s, pc.sample_count - 1u)].xyz) >= distance_;
    bits |= behind && s < pc.sample_count ? 1u << k : 0u;
  }
  pc.table.at[i] = bits;
}
