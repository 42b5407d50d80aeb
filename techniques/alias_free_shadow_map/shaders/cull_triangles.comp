// Which triangles cast: those that do are listed, so that the lanes of cast_triangles.comp all have work. Those of closed
// meshes that turn away from the light are marked, to tell view samples on a mesh's inside.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/alias_free_shadow_map/shaders/cast.glsl"

shared uint group_casters, group_fronts, first_caster, first_front;

void main() {
  if (gl_LocalInvocationIndex == 0u) group_casters = group_fronts = 0u;
  const vec3 lo = push.frame.f.sample_lo.xyz, hi = push.frame.f.sample_hi.xyz;
  const vec4 light = push.frame.f.light;
  const bool both_faces = push.frame.f.both_faces != 0u;
  const uint first = linear_group() * group_lanes * triangles_per_lane + gl_LocalInvocationIndex;
  uint casters = 0u, fronts = 0u;   // a bit per triangle of this invocation
  for (uint i = 0u; i < triangles_per_lane; ++i) {
    const uint t = first + i * group_lanes;
    if (t >= push.count) break;
    const Caster caster = load_caster(t, light);
    const bool closed = (push.closed.at[t >> 5u] >> (t & 31u) & 1u) != 0u;
    const bool faces_it = caster.light_side > 0.0, turned = caster.light_side < 0.0;
    if (closed) push.away.at[t] = turned ? 1u : 0u;
    const bool casts = (faces_it || turned) && !hides_nothing(caster, lo, hi);
    const bool front = closed && !both_faces && faces_it;
    casters |= casts && !front ? 1u << i : 0u;
    fronts |= casts && front ? 1u << i : 0u;
  }
  barrier();
  uint caster = atomicAdd(group_casters, uint(bitCount(casters))), front = atomicAdd(group_fronts, uint(bitCount(fronts)));
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    first_caster = atomicAdd(push.progress.p.caster_count, group_casters);
    first_front = atomicAdd(push.progress.p.front_count, group_fronts);
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
