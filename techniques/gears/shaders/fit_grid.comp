// The grid's fit. STAGE 0: histograms of the view samples' places on C's image plane, over the whole plane (v / (1 + |v|)).
// STAGE 1: from them the rectangle that the grid covers: the 3rd to the 97th percentile and 15 % more at each side, at
// most what there is. A few far view samples would otherwise leave all others in one cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/gears/shaders/frame.glsl"
#include "techniques/gears/shaders/grid_camera.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint LANES = 64;
layout(constant_id = 1) const uint STAGE = 0;

layout(set = 0, binding = 0) uniform Texels frame_texels;    // FrameConstants
layout(set = 0, binding = 1) uniform Texels origin_texels;   // per pixel: P' (w = 0: no view sample),
layout(set = 0, binding = 2) uniform Texels normal_texels;   // Ng
layout(push_constant) uniform Push { FitGridConstants pc; };

const uint BINS = 1024u;

float plane_of(float bin, float unit) {
  float t = clamp(bin / float(BINS) * 2.0 - 1.0, -0.9999, 0.9999);
  return t / (1.0 - abs(t)) * unit;
}

void add_samples() {
  uint columns = (pc.width + pc.step - 1u) / pc.step, rows = (pc.height + pc.step - 1u) / pc.step;
  uint i = linear_group() * LANES + gl_LocalInvocationID.x;
  if (i >= columns * rows) return;
  uint pixel = (i / columns) * pc.step * pc.width + (i % columns) * pc.step;
  FrameConstants f = camera_constants(frame_texels);
  vec4 o = texel(origin_texels, pixel);
  if (!reachable(f.light, o, texel(normal_texels, pixel).xyz, pc.slack)) return;
  GridPoint q = project(f, to_working(f.light, o.xyz));
  if (perspective(f) && !(q.z > f.near)) return;
  vec2 v = q.at / f.grid_unit, t = v / (1.0 + abs(v));
  uvec2 bin = uvec2(clamp((t * 0.5 + 0.5) * float(BINS), 0.0, float(BINS - 1u)));
  atomicAdd(pc.histogram.at[bin.x], 1u);
  atomicAdd(pc.histogram.at[BINS + bin.y], 1u);
}

void fit(uint axis) {
  uint all = 0u;
  for (uint b = 0u; b < BINS; b++) all += pc.histogram.at[axis * BINS + b];
  uint low = all * 3u / 100u, high = all - low, before = 0u;
  uint first = BINS, q0 = BINS, q1 = 0u, last = 0u;
  for (uint b = 0u; b < BINS; b++) {
    uint n = pc.histogram.at[axis * BINS + b];
    first = n > 0u && first == BINS ? b : first;
    last = n > 0u ? b : last;
    q0 = before + n > low && q0 == BINS ? b : q0;
    q1 = n > 0u && before < high ? b : q1;
    before += n;
  }
  float unit = texel(frame_texels, pad_texel).z;
  float lo = plane_of(float(first), unit), hi = plane_of(float(last) + 1.0, unit);
  float a = plane_of(float(q0), unit), b = plane_of(float(q1) + 1.0, unit), more = (b - a) * 0.15;
  lo = max(lo, a - more);
  hi = min(hi, b + more);
  pc.header.h.grid_lo[axis] = all == 0u ? 0.0 : lo;
  pc.header.h.grid_scale[axis] = all == 0u ? 1.0 : float(pc.grid_size) / max(hi - lo, 1e-30);
}

void main() {
  if (STAGE == 0u) add_samples();
  if (STAGE == 1u && gl_LocalInvocationID.x < 2u) fit(gl_LocalInvocationID.x);
}
