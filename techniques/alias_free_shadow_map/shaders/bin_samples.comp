// View samples to the lists of their texels [Sintorn2008, sec. 3.1]. STAGE 0 counts, and keeps each one's place in its
// list; between the stages the lengths are summed up; STAGE 1 writes the lists, one dense array.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint STAGE = 0;
layout(constant_id = 1) const bool CUBE = false;
layout(push_constant, scalar) uniform Push { BinPush push; };

uint texel_of(vec3 q, const Face face, uint row, uint n) {
  const vec2 at = (project(face, q).xy - face.window.xy) * face.window.zw;
  const uvec2 texel = uvec2(clamp(at, vec2(0.0), vec2(float(n - 1u))));
  return (row + texel.y) * n + texel.x;
}

// What is the same for all view samples is loaded once for several of them: loads are what this kernel costs.
void count_samples(uint first) {
  const uint n = push.frame.f.grid_size;
  const vec3 center = push.frame.f.center.xyz;
  const Face face = push.frame.f.faces[0];
  for (uint i = 0u; i < samples_per_lane; ++i) {
    const uint pixel = first + i * group_lanes;
    if (pixel >= push.count) break;
    const uvec4 s = push.samples.at[pixel];
    const vec3 q = uintBitsToFloat(s.xyz) - center;
    uint texel = no_slot, place = no_slot;
    if (s.w != not_listed) {
      const uint index = CUBE ? cube_face(q) : 0u;
      if (CUBE)
        texel = texel_of(q, push.frame.f.faces[index], index * n, n);
      else
        texel = texel_of(q, face, 0u, n);
      place = atomicAdd(push.lengths.at[texel], 1u);
    }
    push.texels.at[pixel] = texel;
    push.slots.at[pixel] = place;
  }
}

// A view sample that faces the light, on a triangle of a closed mesh that does not, is seen from the mesh's inside:
// through a silhouette's rounding, or by a camera within. There, light comes in through triangles that face it.
void note_inner(uint slot) {
  const uint place = atomicAdd(push.progress.p.inner_count, 1u);
  if (place < most_inner) push.progress.p.inner[place] = slot;
}

void fill_lists(uint first) {
  uint inner = 0u;   // a bit per view sample of this invocation
  for (uint i = 0u; i < samples_per_lane; ++i) {
    const uint pixel = first + i * group_lanes;
    if (pixel >= push.count) break;
    const uint texel = push.texels.at[pixel];
    if (texel != no_slot) {
      const uint slot = push.offsets.at[texel] + push.slots.at[pixel];
      const uvec4 s = push.samples.at[pixel];
      push.slots.at[pixel] = slot;
      push.lists.at[slot] = s;
      inner |= push.away.at[s.w] != 0u ? 1u << i : 0u;
    }
  }
  // Not among the stores above, where every view sample would pay for it.
  for (uint bits = inner; bits != 0u; bits &= bits - 1u)
    note_inner(push.slots.at[first + uint(findLSB(bits)) * group_lanes]);
}

void main() {
  const uint first = linear_group() * group_lanes * samples_per_lane + gl_LocalInvocationIndex;
  if (STAGE == 0u)
    count_samples(first);
  else
    fill_lists(first);
}
