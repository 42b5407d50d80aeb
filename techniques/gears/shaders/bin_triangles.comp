// Triangles to the cells of the grid: a triangle's truncated shadow volume, projected with C, touches the cells of its
// bounding rectangle. STAGE 0 counts, STAGE 1 writes the lists of the cells [cell_begin, cell_end).
//
// A triangle with more than SMALL cells goes to the list of large ones, done with an invocation per triangle and row of
// cells (LARGE): that balances the lanes and bounds the turns of an invocation by the grid's size.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/gears/shaders/frame.glsl"
#include "techniques/gears/shaders/grid_camera.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint LANES = 64;
layout(constant_id = 1) const uint STAGE = 0;
layout(constant_id = 2) const bool LARGE = false;

layout(push_constant) uniform Push { BinTrianglesConstants pc; };

const uint SMALL = 64u;

struct Cells {
  uint x0, y0, x1, y1;
  bool rest;                   // the cell after the last too, and all others
};

void add(inout vec4 box, vec2 at, float error) {
  box = vec4(min(box.xy, at - error), max(box.zw, at + error));
}

Cells cells_of(uint slot) {
  FrameConstants f = pc.frame.f;
  Header h = pc.header.h;
  float farthest = uintBitsToFloat(h.farthest);
  vec4 box = vec4(1e30, 1e30, -1e30, -1e30);
  bool everywhere = false;
  for (uint k = 0u; k < 3u; k++) {
    vec3 b = to_camera(f, pc.triangles.at[slot * 3u + k].xyz);
    if (!perspective(f)) {
      add(box, b.xy, f.pad);   // the shadow runs along the camera's axis
      continue;
    }
    everywhere = everywhere || !(b.z > f.near);
    add(box, b.xy / b.z, 2.0 * f.pad / b.z);
    for (uint c = 0u; c < f.light.corner_count; c++) {
      // Light corners in working space, then before the camera.
      vec3 L = to_camera(f, to_working(f.light, f.light.corners[c].xyz)), d = b - L;
      if (f.paper_extrusion != 0u) {
        vec3 e = b + d;
        everywhere = everywhere || !(e.z > f.near);
        add(box, e.xy / e.z, 4.0 * f.pad / e.z);
      } else if (b.z < farthest) {
        everywhere = everywhere || !(d.z > f.near);
        add(box, (L.xy + d.xy * ((farthest - L.z) / d.z)) / farthest, 2.0 * f.pad / d.z);
      }
    }
  }
  vec2 lo = vec2(h.grid_lo[0], h.grid_lo[1]), scale = vec2(h.grid_scale[0], h.grid_scale[1]);
  vec2 slack = 1e-3 + 4e-6 * max(max(abs(box.xy), abs(box.zw)), abs(lo)) * scale;
  float last = float(pc.grid_size - 1u);
  vec2 from = clamp((box.xy - lo) * scale - slack, 0.0, last), to = clamp((box.zw - lo) * scale + slack, 0.0, last);
  uint end = pc.grid_size - 1u;
  // Not-a-number comparisons are false, so that what cannot be placed goes everywhere.
  bool placed = !everywhere && all(lessThanEqual(from, to));
  return Cells(placed ? uint(from.x) : 0u, placed ? uint(from.y) : 0u, placed ? uint(to.x) : end, placed ? uint(to.y) : end,
               !placed);
}

void assign_to(uint cell, uint slot) {
  if (STAGE == 0u) {
    atomicAdd(pc.counts.at[cell], 1u);
  } else if (cell >= pc.cell_begin && cell < pc.cell_end) {
    uint place = atomicAdd(pc.counts.at[cell], 1u);
    pc.assigned.at[pc.offsets.at[cell] - pc.chunk_begin + place] = slot;
  }
}

void main() {
  uint i = linear_group() * LANES + gl_LocalInvocationID.x;
  if (LARGE) {
    uint rows = pc.grid_size + 1u;
    if (i / rows >= pc.large_count) return;
    uint slot = pc.large.at[i / rows], y = i % rows;
    Cells c = cells_of(slot);
    if (y == pc.grid_size) {
      if (c.rest) assign_to(pc.grid_size * pc.grid_size, slot);
    } else if (y >= c.y0 && y <= c.y1) {
      for (uint x = c.x0; x <= c.x1; x++) assign_to(y * pc.grid_size + x, slot);
    }
    return;
  }
  if (i >= pc.slots || pc.triangles.at[i * 3u].w != 0.0) return;
  Cells c = cells_of(i);
  uint columns = c.x1 - c.x0 + 1u, cells = columns * (c.y1 - c.y0 + 1u);
  if (c.rest || cells > SMALL) {
    if (STAGE == 0u) pc.large.at[atomicAdd(pc.header.h.large_count, 1u)] = i;
    return;
  }
  uint x = c.x0, y = c.y0;
  for (uint k = 0u; k < cells; k++) {
    assign_to(y * pc.grid_size + x, i);
    bool wrap = x == c.x1;
    x = wrap ? c.x0 : x + 1u;
    y += wrap ? 1u : 0u;
  }
}
