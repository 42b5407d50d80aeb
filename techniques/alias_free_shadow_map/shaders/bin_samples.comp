// View samples to the lists of their texels [Sintorn 2008, sec. 3.1]. STAGE 0 counts, and keeps each one's place in its
// list; between the stages the lengths are summed up; STAGE 1 writes the lists, one dense array.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint STAGE = 0;
layout(push_constant, scalar) uniform Push { BinPush push; };

uint texel_of(vec3 q) {
  const uint n = push.frame.f.grid_size;
  const uint index = push.frame.f.face_count > 1u ? cube_face(q) : 0u;
  const Face face = push.frame.f.faces[index];
  const vec2 at = (project(face, q).xy - face.window.xy) * face.window.zw;
  const uvec2 texel = uvec2(clamp(at, vec2(0.0), vec2(float(n - 1u))));
  return (index * n + texel.y) * n + texel.x;
}

void main() {
  const uint pixel = linear_group() * group_lanes + gl_LocalInvocationIndex;
  if (pixel >= push.count) return;
  if (STAGE == 0u) {
    const vec4 position = push.position.at[pixel];
    uint texel = no_slot, place = no_slot;
    if (position.w > 0.0 && may_be_lit(position.xyz, push.normal.at[pixel].xyz, push.frame.f.light, push.frame.f.emission)) {
      texel = texel_of(push.origin.at[pixel].xyz - push.frame.f.center.xyz);
      place = atomicAdd(push.lengths.at[texel], 1u);
    }
    push.texels.at[pixel] = texel;
    push.slots.at[pixel] = place;
  } else {
    const uint texel = push.texels.at[pixel];
    if (texel == no_slot) return;
    const uint slot = push.offsets.at[texel] + push.slots.at[pixel];
    push.slots.at[pixel] = slot;
    const vec3 q = push.origin.at[pixel].xyz - push.frame.f.center.xyz;
    const uint own = push.frame.f.leave_out_own != 0u ? push.triangle.at[pixel] : no_slot;
    push.lists.at[slot] = vec4(q, uintBitsToFloat(own));
  }
}
