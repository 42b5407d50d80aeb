// One level of the box tree from the level below: node n has the children n SG + 1 ... n SG + SG.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/gears/shaders/frame.glsl"
layout(local_size_x_id = 1) in;
layout(constant_id = 0) const uint SG = 8;     // children of a node
layout(constant_id = 1) const uint LANES = 64;
#include "techniques/common/shaders/subgroup.glsl"

layout(push_constant) uniform Push { RefitConstants pc; };

void main() {
  uint i = linear_group() * LANES + gl_LocalInvocationID.x;
  if (i >= pc.count) return;
  uint node = pc.first + i;
  vec3 lo = vec3(1e30), hi = vec3(-1e30);
  for (uint k = 1u; k <= SG; k++) {
    uint child = node * SG + k;
    if (child < pc.node_count) {
      vec4 a = pc.boxes.at[child * 2u], b = pc.boxes.at[child * 2u + 1u];
      lo = lower(lo, a.xyz);
      hi = upper(hi, vec3(a.w, b.xy));
    }
  }
  pc.boxes.at[node * 2u] = vec4(lo, hi.x);
  pc.boxes.at[node * 2u + 1u] = vec4(hi.yz, 0.0, 0.0);
}
