// Casters that turn their back to the light's pivot. Their boundary is the silhouette; they themselves are crossed by
// a segment from P to the light once for each closed mesh that it passes through.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "techniques/soft_shadow_volume/shaders/buffers.glsl"
#include "techniques/soft_shadow_volume/shaders/side.glsl"
layout(local_size_x = WEDGE_GROUP) in;
layout(push_constant, scalar) uniform Push { ExtractPush push; };

bool before(vec3 a, vec3 b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

// A side for every edge, opposite for its other direction even where it is zero: so that of two triangles that share
// the edge one alone has a ray through it.
bool on_left(vec3 p, vec3 a, vec3 b, vec3 center) {
  const bool forwards = before(a, b);
  const bool left = side_of(p, forwards ? a : b, forwards ? b : a, center) >= 0.0;
  return forwards == left;
}

void main() {
  const uint t = linear_invocation();
  if (t >= push.count) return;
  const uvec3 v = uvec3(push.indices.at[3 * t], push.indices.at[3 * t + 1], push.indices.at[3 * t + 2]);
  const vec3 a = push.positions.at[v.x], b = push.positions.at[v.y], c = push.positions.at[v.z];
  const vec3 light = push.light.xyz, eye = push.eye.xyz;
  precise const vec3 n = cross(b - a, c - a);
  precise const float height = dot(n, light - a);
  const bool turned = push.casts.at[t] != 0 && height < 0.0;
  push.turned.at[t] = turned ? 1 : 0;
  if (!turned) return;
  // The eye lies in a volume of each of them that is between it and the light.
  if (dot(n, eye - a) > 0.0 && on_left(eye, a, b, light) && on_left(eye, b, c, light) && on_left(eye, c, a, light))
    atomicAdd(push.extraction.at.eye_count, 1);
  const vec3 middle = (a + b + c) / 3.0;
  const float radius = max(distance(middle, a), max(distance(middle, b), distance(middle, c)));
  if (distance(middle, eye) <= radius + push.light.w) {
    const uint at = atomicAdd(push.extraction.at.near_caps, 3);
    push.extraction.near_cap[at] = push.extraction.near_cap[at + 1] = push.extraction.near_cap[at + 2] = t;
  }
}
