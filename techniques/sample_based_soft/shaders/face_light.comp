// Which side of each triangle the light sees: 1 its front, all of the light; 2 its back; 0 both, or nearly edge-on.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/sample_based_soft/shaders/frame.glsl"
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { CastersConstants pc; };
#include "techniques/sample_based_soft/shaders/corners.glsl"

void main() {
  uint t = linear_invocation();
  if (t >= pc.triangle_count) return;
  FrameConstants f = caster_constants();
  vec3 a = corner(f.light, 3u * t), b = corner(f.light, 3u * t + 1u), c = corner(f.light, 3u * t + 2u);
  vec3 n = cross(b - a, c - a);
  vec3 middle = 0.5 * (f.light_lo.xyz + f.light_hi.xyz) - a, extent = 0.5 * (f.light_hi.xyz - f.light_lo.xyz) + 4.0 * f.pad;
  float height = dot(n, middle), reach = dot(abs(n), extent);
  // The normal's own error: its products' rounding, and what the corners' moves by `pad` may turn it.
  vec3 u = abs(b - a), v = abs(c - a);
  vec3 turn = 4.0 * f.pad * (u.yzx + u.zxy + v.yzx + v.zxy) + 1e-6 * (u.yzx * v.zxy + u.zxy * v.yzx);
  reach += dot(turn, abs(middle) + extent);
  pc.facing.at[t] = height > reach ? 1u : height < -reach ? 2u : 0u;
}
