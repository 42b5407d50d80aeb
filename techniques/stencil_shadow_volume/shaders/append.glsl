// Appending to the index lists, with one global atomic per workgroup and list. Every invocation calls reserve() for the
// lists that it adds to, then all call commit(), then first() says where to write.
layout(local_size_x = VOLUME_GROUP) in;
layout(push_constant, scalar) uniform Push { ExtractPush push; };

shared uint group_size[LIST_COUNT], group_first[LIST_COUNT];

void open_lists() {
  if (gl_LocalInvocationIndex < LIST_COUNT) group_size[gl_LocalInvocationIndex] = 0;
  barrier();
}

uint reserve(uint list, uint indices) { return indices > 0 ? atomicAdd(group_size[list], indices) : 0; }

void commit() {
  barrier();
  const uint list = gl_LocalInvocationIndex;
  if (list < LIST_COUNT && group_size[list] > 0)
    group_first[list] = atomicAdd(push.draws.draws.list[list].index_count, group_size[list]);
  barrier();
}

uint first(uint list, uint reserved) { return group_first[list] + reserved; }

void put(uint list, uint at, uint a, uint b, uint c) {
  UintArray indices = push.lists.lists.at[list];
  indices.at[at] = a, indices.at[at + 1] = b, indices.at[at + 2] = c;
}

bool before(uint a, uint b) {
  const vec3 p = push.positions.at[a], q = push.positions.at[b];
  return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
}

// The side of a volume whose near cap, seen from the light, runs a -> b counter-clockwise: outwards, so b -> a.
//
// Its triangles are slivers: an edge of the mesh, or its image at infinity, and two edges that are as long as the picture.
// Rasterisers take the slope of depth from the two edges at a triangle's first corner [lavapipe: first two corners exchanged where
// it turns the other way]; were both long, what is left of their products would be rounding. So the short edge comes first. The
// diagonal is the same whichever way the side runs: the two sides on an edge that two volumes share are the same triangles with
// their first two corners exchanged, so that rasterisers find the same fragments and depths in both, and they cancel.
void put_side(uint at, uint a, uint b) {
  const uint n = push.vertex_count;
  const uint end = before(b, a) ? b : a;   // of the diagonal, on the mesh
  const uint far = (end == a ? b : a) + n;
  put(LIST_SIDES, at, b, a, far);
  if (push.indices_per_quad >= 6) put(LIST_SIDES, at + 3, a + n, b + n, end);
  if (push.indices_per_quad >= 9) put(LIST_SIDES, at + 6, b + n, a + n, 2 * n);
}
