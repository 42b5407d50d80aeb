// Silhouette edges, in the order of the edges: sums over them are then the same in every run. STAGE 0 marks them,
// 1 (after a prefix sum) writes them.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
layout(local_size_x = WEDGE_GROUP) in;
layout(constant_id = 0) const uint STAGE = 0;
layout(push_constant, scalar) uniform Push { ExtractPush push; };

void main() {
  const uint e = linear_invocation();
  if (e >= push.count) return;
  const uvec4 edge = push.edges.at[e];
  int weight = 0;
  for (uint i = 0; i < edge.w; ++i) {
    const uint face = push.faces.at[edge.z + i];
    const int turned = int(push.turned.at[face >> 1]);
    weight += (face & 1) != 0 ? -turned : turned;
  }
  if (STAGE == 0) {
    push.marks.at[e] = weight != 0 ? 1 : 0;
    return;
  }
  if (weight == 0) return;
  Silhouette s;
  s.vertex[0] = edge.x, s.vertex[1] = edge.y, s.weight = weight, s.unused = 0;
  push.silhouettes.at[push.places.at[e]] = s;
}
