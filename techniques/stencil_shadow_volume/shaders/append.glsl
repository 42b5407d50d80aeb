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
// Rasterisers take the slope of depth from the two edges at a triangle's first corner; were both long, what is left of their
// products would be rounding. So the first corner is an end of the short edge.
//
// The two sides on an edge that two volumes share must cancel in every pixel: same fragments, same depths. So both have the same
// diagonal, and each triangle the same first corner whichever way the side runs, with the other two exchanged: a rasteriser turns
// one of them by exchanging these two again [lavapipe], and a clipper's fans about the first corner are the same triangles.
void put_turned(uint at, bool turned, uint corner, uint b, uint c) {
  if (turned)
    put(LIST_SIDES, at, corner, c, b);
  else
    put(LIST_SIDES, at, corner, b, c);
}

void put_side(uint at, uint a, uint b) {
  const uint n = push.vertex_count;
  const bool turned = before(b, a);
  const uint near = turned ? b : a;  // the diagonal goes from here to the other's image at infinity
  const uint other = turned ? a : b;
  put_turned(at, turned, near, other + n, other);  // unturned: a, b + n, b, that is b, a, b + n
  if (push.indices_per_quad >= 6) put_turned(at + 3, turned, other + n, near, near + n);
  if (push.indices_per_quad >= 9) put_turned(at + 6, turned, other + n, near + n, 2 * n);
}
