// Which side each triangle turns to the light, and its own parts of the volumes: caps, and sides when every triangle has
// a volume of its own. Sides, caps and silhouettes all follow from the one sign decided here, so the volumes are closed
// whatever its rounding.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/stencil_shadow_volume/shaders/buffers.glsl"
#include "techniques/stencil_shadow_volume/shaders/append.glsl"

int facing_of(uvec3 v) {
  const vec3 a = push.positions.at[v.x], b = push.positions.at[v.y], c = push.positions.at[v.z];
  precise const float s = dot(cross(b - a, c - a), push.light.xyz - push.light.w * a);
  if ((push.make & BACK_FACING_ONLY) != 0 && s > 0) return 0;
  return s > 0 ? 1 : s < 0 ? -1 : 0;
}

void main() {
  open_lists();
  const uint t = linear_invocation();
  int f = 0;
  uvec3 v = uvec3(0);
  if (t < push.count) {
    v = uvec3(push.indices.at[3 * t], push.indices.at[3 * t + 1], push.indices.at[3 * t + 2]);
    f = facing_of(v);
    push.facing.at[t] = f;
  }
  const uint cap = f > 0 ? LIST_NEAR_FRONT : LIST_NEAR_BACK;
  const bool sides = f != 0 && (push.make & MAKE_SIDES) != 0;
  const bool near = f != 0 && (push.make & MAKE_NEAR) != 0;
  const bool far = f != 0 && (push.make & MAKE_FAR) != 0;
  const uint side_at = reserve(LIST_SIDES, sides ? 3 * push.indices_per_quad : 0);
  const uint near_at = reserve(cap, near ? 3 : 0);
  const uint far_at = reserve(LIST_FAR, far ? 3 : 0);
  commit();
  if (near) put(cap, first(cap, near_at), v.x, v.y, v.z);
  if (f < 0) v = v.xzy;  // from here on counter-clockwise seen from the light
  if (far) put(LIST_FAR, first(LIST_FAR, far_at), v.x + push.vertex_count, v.z + push.vertex_count, v.y + push.vertex_count);
  if (!sides) return;
  const uint at = first(LIST_SIDES, side_at);
  put_side(at, v.x, v.y);
  put_side(at + push.indices_per_quad, v.y, v.z);
  put_side(at + 2 * push.indices_per_quad, v.z, v.x);
}
