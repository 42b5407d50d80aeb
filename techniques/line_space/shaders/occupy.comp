// A pair is a triangle and a node that it overlaps. STAGE 0: marks the subnodes that it overlaps, and counts them.
// STAGE 1: writes the pairs of the next level.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/line_space/shaders/buffers.glsl"
#define VEC3 vec3
#include "techniques/line_space/shaders/overlap.glsl"
layout(constant_id = 1) const uint STAGE = 0;
layout(push_constant, scalar) uniform Push { OccupyPush push; };

vec3 corner(uint triangle, uint k) {
  return to_leaves(push.positions.at[push.indices.at[3u * triangle + k]], push.lo, push.scale);
}

// The child's number among the occupied subnodes of its node.
uint rank_of(uint node, uint subnode) {
  uint before = 0u, word = subnode >> 5u;
  for (uint w = 0u; w < word; ++w) before += bitCount(push.occupancy.at[node * occupancy_words + w]);
  return before + bitCount(push.occupancy.at[node * occupancy_words + word] & ((1u << (subnode & 31u)) - 1u));
}

void main() {
  const uint pair = linear_invocation();
  if (pair >= push.count) return;
  const uint triangle = push.pairs.at[2u * pair], index = push.pairs.at[2u * pair + 1u];
  const Node node = push.nodes.at[index];
  const vec3 lo = vec3(node.x, node.y, node.z);
  const float size = float(push.subnode);
  const vec3 half_size = vec3(0.5 * size) + push.padding;
  const Corners t = Corners(corner(triangle, 0u), corner(triangle, 1u), corner(triangle, 2u));
  const uvec3 first = uvec3(first_subnode(t.a.x, t.b.x, t.c.x, push.padding.x, lo.x, size, N),
                            first_subnode(t.a.y, t.b.y, t.c.y, push.padding.y, lo.y, size, N),
                            first_subnode(t.a.z, t.b.z, t.c.z, push.padding.z, lo.z, size, N));
  const uvec3 last = uvec3(last_subnode(t.a.x, t.b.x, t.c.x, push.padding.x, lo.x, size, N),
                           last_subnode(t.a.y, t.b.y, t.c.y, push.padding.y, lo.y, size, N),
                           last_subnode(t.a.z, t.b.z, t.c.z, push.padding.z, lo.z, size, N));
  uint found = 0u;
  const uint written = STAGE == 1u ? push.counts.at[pair] : 0u;
  for (uint z = first.z; z <= last.z; ++z)
    for (uint y = first.y; y <= last.y; ++y)
      for (uint x = first.x; x <= last.x; ++x) {
        if (!overlaps(t, lo + (vec3(x, y, z) + 0.5) * size, half_size)) continue;
        const uint subnode = (z * N + y) * N + x;
        if (STAGE == 0u) {
          atomicOr(push.occupancy.at[index * occupancy_words + (subnode >> 5u)], 1u << (subnode & 31u));
        } else {
          push.next_pairs.at[2u * (written + found)] = triangle;
          push.next_pairs.at[2u * (written + found) + 1u] = push.first_child.at[index] + rank_of(index, subnode);
        }
        ++found;
      }
  if (STAGE == 0u) push.counts.at[pair] = found;
}
