// From the triangle seen at each pixel's centre to the view sample: the one place where positions and normals are made.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "samples/shaders/view_samples_params.h"
layout(local_size_x = 64) in;
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Params { ViewSamplesParams p; };
layout(push_constant) uniform Push { Params params; } pc;

const uint no_triangle = 0xffffffffu;

// Where the ray eye + t d meets the plane of (a, b, c), as weights of b and c [Moller 1997], clamped to the triangle:
// rasterisation snaps vertices to 1/256 pixel, so a pixel's centre may lie a hair outside the triangle that covers it.
// Differences of vertices come first, so that the error scales with the triangle and not with the distance.
vec2 clamped_barycentrics(vec3 eye, vec3 d, vec3 a, vec3 b, vec3 c) {
  vec3 e1 = b - a, e2 = c - a, s = eye - a;
  precise vec3 h = cross(d, e2);
  precise float det = dot(e1, h);
  precise vec3 q = cross(s, e1);
  vec2 w = det != 0.0 ? vec2(dot(s, h), dot(d, q)) / det : vec2(1.0 / 3.0);
  vec3 all = max(vec3(1.0 - w.x - w.y, w.x, w.y), vec3(0.0));
  return all.yz / (all.x + all.y + all.z);
}

void main() {
  uint pixel = linear_invocation();
  ViewSamplesParams p = pc.params.p;
  if (pixel >= p.pixels) return;
  uint t = p.triangle.at[pixel];
  vec2 w = vec2(0.0);
  vec4 position = vec4(0.0), origin = vec4(0.0), ng = vec4(0.0), ns = vec4(0.0);
  if (t != no_triangle) {
    uint ia = p.indices.at[3u * t], ib = p.indices.at[3u * t + 1u], ic = p.indices.at[3u * t + 2u];
    vec3 a = p.vertex_positions.at[ia], b = p.vertex_positions.at[ib], c = p.vertex_positions.at[ic];
    vec3 d = p.corner + (float(pixel % p.width) + 0.5) * p.step_x + (float(pixel / p.width) + 0.5) * p.step_y;
    w = clamped_barycentrics(p.eye, d, a, b, c);
    vec3 point = a + w.x * (b - a) + w.y * (c - a);
    vec3 n = normalize(cross(b - a, c - a));
    if (dot(n, p.eye - point) < 0.0) n = -n;
    vec3 na = p.vertex_normals.at[ia], nb = p.vertex_normals.at[ib], nc = p.vertex_normals.at[ic];
    vec3 m = (1.0 - w.x - w.y) * na + w.x * nb + w.y * nc;
    m = dot(m, m) > 0.0 ? normalize(m) : n;
    if (dot(m, n) < 0.0) m = -m;
    position = vec4(point, dot(point - p.eye, p.forward));
    origin = vec4(point + p.offset * n, 1.0);
    ng = vec4(n, 0.0);
    ns = vec4(m, 0.0);
  }
  p.barycentrics.at[pixel] = w;
  p.position.at[pixel] = position;
  p.origin.at[pixel] = origin;
  p.geometric_normal.at[pixel] = ng;
  p.shading_normal.at[pixel] = ns;
}
