// Smooth shading that never lights what turns away from the light [Sintorn2008, sec. 4.3]:
// alpha l_f + (1 - alpha) l_bend, alpha = min(1, max(c l_bend, 0)).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/sample_based_soft/shaders/shade.glsl"
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { ShadeConstants pc; };

vec3 place(uint vertex) {
  return vec3(pc.positions.at[3u * vertex], pc.positions.at[3u * vertex + 1u], pc.positions.at[3u * vertex + 2u]);
}

void main() {
  uint pixel = linear_invocation();
  if (pixel >= pc.count) return;
  uint t = pc.triangle.at[pixel];
  float lit = 0.0;
  if (t != 0xffffffffu) {
    uint i = pc.indices.at[3u * t], j = pc.indices.at[3u * t + 1u], k = pc.indices.at[3u * t + 2u];
    vec3 a = place(i), n = cross(place(j) - a, place(k) - a);
    // Seen from the side that the winding calls the back, all faces are turned around.
    bool back = dot(n, pc.normal.at[pixel].xyz) < 0.0;
    vec3 bent;
    for (uint q = 0u; q < 3u; q++) {
      uint vertex = 2u * pc.corner.at[q == 0u ? i : q == 1u ? j : k];
      bent[q] = back ? -pc.bent.at[vertex + 1u] : pc.bent.at[vertex];
    }
    vec2 weight = vec2(pc.barycentrics.at[2u * pixel], pc.barycentrics.at[2u * pixel + 1u]);
    float l_bend = dot(bent, vec3(1.0 - weight.x - weight.y, weight));
    vec3 light = vec3(pc.light[0], pc.light[1], pc.light[2]);
    float l_f = dot(pc.shading_normal.at[pixel].xyz, normalize(light - pc.position.at[pixel].xyz));
    float alpha = min(1.0, max(pc.weight * l_bend, 0.0));
    lit = max(alpha * l_f + (1.0 - alpha) * l_bend, 0.0);
  }
  pc.cosines.at[pixel] = lit;
}
