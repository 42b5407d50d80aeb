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

// The side of a volume whose near cap, seen from the light, runs a -> b counter-clockwise: outwards, so b -> a.
void put_side(uint at, uint a, uint b) {
  const uint n = push.vertex_count;
  put(LIST_SIDES, at, b, a, a + n);
  if (push.indices_per_quad >= 6) put(LIST_SIDES, at + 3, b, a + n, b + n);
  if (push.indices_per_quad >= 9) put(LIST_SIDES, at + 6, 2 * n, b + n, a + n);
}
