// How much light the faces around each vertex get at least, and at most [Sintorn2008, sec. 4.3]: l_bend = min dot(l, n_F).
// The largest is what those see who look at the faces' backs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/sample_based_soft/shaders/shade.glsl"
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { ShadeConstants pc; };

vec3 place(uint vertex) {
  return vec3(pc.positions.at[3u * vertex], pc.positions.at[3u * vertex + 1u], pc.positions.at[3u * vertex + 2u]);
}

void main() {
  uint v = linear_invocation();
  if (v >= pc.count) return;
  vec3 light = vec3(pc.light[0], pc.light[1], pc.light[2]);
  float least = 1e30, most = -1e30;
  for (uint i = pc.first_faces.at[v]; i < pc.first_faces.at[v + 1u]; i++) {
    uint corner = pc.faces.at[i], t = 3u * (corner / 3u);
    vec3 a = place(pc.indices.at[t]), b = place(pc.indices.at[t + 1u]), c = place(pc.indices.at[t + 2u]);
    vec3 n = cross(b - a, c - a), at = place(pc.indices.at[corner]);
    float size = length(n);
    if (!(size > 0.0)) continue;   // a degenerate face turns nowhere
    float lit = dot(n / size, normalize(light - at));
    least = min(least, lit);
    most = max(most, lit);
  }
  pc.bent.at[2u * v] = least;
  pc.bent.at[2u * v + 1u] = most;
}
