// Which triangles cast, by the side that they turn to the light: those that do are listed, so that the lanes of
// cast_triangles.comp all have work. Those of closed meshes that turn away from it are marked, to tell view samples on a
// mesh's inside.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/buffers.glsl"
#include "techniques/alias_free_shadow_map/shaders/corners.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FacingPush push; };

shared uint group_casters, group_fronts, first_caster, first_front;

void main() {
  if (gl_LocalInvocationIndex == 0u) group_casters = group_fronts = 0u;
  const uint first = linear_group() * group_lanes * triangles_per_lane + gl_LocalInvocationIndex;
  uint casters = 0u, fronts = 0u;   // a bit per triangle of this invocation
  for (uint i = 0u; i < triangles_per_lane; ++i) {
    const uint t = first + i * group_lanes;
    if (t >= push.count) break;
    const float side = load_caster(t, push.light).light_side;
    const bool closed = in_closed_mesh(t);
    push.away.at[t] = closed && side < 0.0 ? 1u : 0u;
    const bool front = closed && push.both_faces == 0u && side > 0.0;
    casters |= side != 0.0 && !front ? 1u << i : 0u;
    fronts |= front ? 1u << i : 0u;
  }
  barrier();
  uint caster = atomicAdd(group_casters, uint(bitCount(casters))), front = atomicAdd(group_fronts, uint(bitCount(fronts)));
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    first_caster = atomicAdd(push.counts.at[0], group_casters);
    first_front = atomicAdd(push.counts.at[1], group_fronts);
  }
  barrier();
  caster += first_caster;
  front += first_front;
  for (uint i = 0u; i < triangles_per_lane; ++i) {
    const uint t = first + i * group_lanes;
    if ((casters >> i & 1u) != 0u) push.casters.at[caster++] = t;
    if ((fronts >> i & 1u) != 0u) push.casters.at[push.count - 1u - front++] = t;
  }
}
