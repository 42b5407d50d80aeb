// Sides on silhouette edges. Each casting triangle's volume has a side on each of its edges; on an edge that several
// triangles share, opposite sides cancel, and what is left is the sum of +1 for each triangle that runs the edge forwards
// as the light sees it and -1 for each that runs it backwards. This is right for open and non-manifold edges too
// [Kim2008].
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/stencil_shadow_volume/shaders/buffers.glsl"
#include "techniques/stencil_shadow_volume/shaders/append.glsl"

shared uint group_edges, group_quads;

void main() {
  if (gl_LocalInvocationIndex == 0) group_edges = group_quads = 0;
  open_lists();
  const uint e = linear_invocation();
  int sum = 0;
  uvec4 edge = uvec4(0);
  if (e < push.count) {
    edge = push.edges.at[e];
    for (uint i = 0; i < edge.w; ++i) {
      const uint face = push.faces.at[edge.z + i];
      const int f = push.facing.at[face >> 1];
      sum += (face & 1) != 0 ? -f : f;
    }
  }
  const uint quads = uint(abs(sum));
  const uint reserved = reserve(LIST_SIDES, quads * push.indices_per_quad);
  if (quads > 0) {
    atomicAdd(group_edges, 1);
    atomicAdd(group_quads, quads);
  }
  commit();
  for (uint i = 0; i < quads; ++i) {
    const uint at = first(LIST_SIDES, reserved) + i * push.indices_per_quad;
    if (sum > 0) put_side(at, edge.x, edge.y);
    else put_side(at, edge.y, edge.x);
  }
  if (gl_LocalInvocationIndex == 0 && group_edges > 0) {
    atomicAdd(push.draws.draws.silhouette_edges, group_edges);
    atomicAdd(push.draws.draws.quads, group_quads);
  }
}
