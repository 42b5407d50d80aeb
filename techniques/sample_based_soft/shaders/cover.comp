// Casters to lists: those whose influence region touches what a list, or (TILES) a tile of lists, covers. Lists look only
// at what their tile has. STAGE 0 counts, STAGE 1 writes; both in the order of the casters, without atomics.
//
// One subgroup does one list, a lane holds a caster. A dispatch takes a part of each parent's casters.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "techniques/sample_based_soft/shaders/frame.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 1) const uint STAGE = 0;
layout(constant_id = 2) const bool TILES = false;
layout(constant_id = 3) const bool FIT = true;
layout(constant_id = 4) const bool SKIP_EMPTY = true;
layout(constant_id = 5) const bool OWN_PLANE = true;      // regions on the plane of the list's farthest view sample
layout(constant_id = 6) const uint OUTLINE = 0;           // texels per caster; 0: its box alone
layout(constant_id = 7) const bool SILHOUETTES = false;   // mark lists that a silhouette's region touches (STAGE 0)
#include "techniques/common/shaders/subgroup.glsl"
#include "techniques/common/shaders/texels.glsl"
#include "techniques/sample_based_soft/shaders/lists.glsl"
#include "techniques/sample_based_soft/shaders/region.glsl"
layout(set = 0, binding = 0) uniform sampler2D regions;     // 2 texels per caster
layout(set = 0, binding = 1) uniform sampler2D edges;       // the same of its potential silhouette edges
layout(set = 0, binding = 2) uniform sampler2D hulls;       // OUTLINE texels per caster
layout(set = 0, binding = 3) uniform sampler2D triangles;   // 3 texels per slot
layout(set = 0, binding = 4) uniform sampler2D frame_texels;
layout(push_constant) uniform Push { CoverConstants pc; };

// Neighbours cost alike; a device that deals its threads contiguous work would leave the dear ones to one of them.
// Over a rectangle of 64 rows; what a dispatch has beyond it does nothing.
uint interleaved(uint n) {
  uint columns = (pc.lists + 63u) / 64u;
  return n < 64u * columns ? (n % 64u) * columns + n / 64u : 0xffffffffu;
}

bool outline_touches(uint caster, uint sides, vec4 rect) {
  bool touches = true;
  for (uint k = 0u; k < OUTLINE; k++) {
    vec4 side = texel(hulls, caster * OUTLINE + min(k, OUTLINE - 1u));
    vec2 nearest = mix(rect.xy, rect.zw, lessThan(side.xy, vec2(0.0)));
    bool within = dot(side.xy, nearest) <= side.z, counts = k < sides;
    touches = touches && (within || !counts);
  }
  return touches;
}

Region region_of(sampler2D boxes, uint caster, FrameConstants f, LightBox light, float w, out float last) {
  vec4 a = texel(boxes, 2u * caster), b = texel(boxes, 2u * caster + 1u);
  last = b.z;
  return box_region(a.xyz - f.eye.xyz, vec3(a.w, b.xy) - f.eye.xyz, light, w, f.near);
}

// Potential silhouette edges of the triangles outside the blocks.
bool listed_edges_touch(FrameConstants f, LightBox light, float w, vec4 rect) {
  bool touched = false;
  for (uint i = 0u; i < pc.list_count; i += SG) {
    uint mine = i + gl_SubgroupInvocationID, slot = pc.listed.at[min(mine, pc.list_count - 1u)];
    vec4 a = texel(triangles, 3u * slot), b = texel(triangles, 3u * slot + 1u), c = texel(triangles, 3u * slot + 2u);
    uint bits = mine < pc.list_count ? uint(b.w) : 0u;
    bool ab = edge_touches(a.xyz - f.eye.xyz, b.xyz - f.eye.xyz, light, w, f.near, f.pad, rect);
    bool bc = edge_touches(b.xyz - f.eye.xyz, c.xyz - f.eye.xyz, light, w, f.near, f.pad, rect);
    bool ca = edge_touches(c.xyz - f.eye.xyz, a.xyz - f.eye.xyz, light, w, f.near, f.pad, rect);
    touched = touched || (ab && (bits & 1u) != 0u) || (bc && (bits & 2u) != 0u) || (ca && (bits & 4u) != 0u);
  }
  return touched;
}

void main() {
  uint n = interleaved(linear_group());
  if (n >= pc.lists) return;
  uint list = pc.first_list + n, lane = gl_SubgroupInvocationID;
  FrameConstants f;
  f.light_lo = texel(frame_texels, light_lo_texel);
  f.light_hi = texel(frame_texels, light_hi_texel);
  f.eye = texel(frame_texels, eye_texel);
  f.window = texel(frame_texels, window_texel);
  vec4 limits = texel(frame_texels, pad_texel);
  f.pad = limits.x;
  f.near = limits.y;
  f.widest = limits.z;
  LightBox light = LightBox(f.light_lo.xyz - f.eye.xyz, f.light_hi.xyz - f.eye.xyz);
  Window window = window_of(f, pc.header, pc.grid_size, FIT);
  float farthest = uintBitsToFloat(pc.farthest.at[(TILES ? list_count(pc.grid_size) : 0u) + list]);
  if (SKIP_EMPTY && farthest == 0.0) return;
  float all = from_ordered(~pc.header.h.farthest);
  float w = 1.0 / ((OWN_PLANE && farthest > 0.0 ? farthest : all) + 2.0 * f.pad);
  vec4 rect = TILES ? tile_rect(window, pc.grid_size, list) : list_rect(window, pc.grid_size, list);
  uint tile = list / tile_lists;
  uint begin = TILES ? 0u : pc.parent_begins.at[tile], count = TILES ? pc.caster_count : pc.parent_counts.at[tile];
  uint at = pc.counts.at[list], out_ = STAGE == 1u ? pc.begins.at[list] - pc.chunk_begin : 0u;
  uint end = min(count, pc.last_parent), penumbra = 0u;
  for (uint i = pc.first_parent; i < end; i += SG) {
    uint mine = i + lane;
    bool real = mine < end;
    uint caster = TILES ? min(mine, pc.caster_count - 1u) : pc.parents.at[begin + min(mine, end - 1u)];
    float last;
    Region r = region_of(regions, caster, f, light, w, last);
    bool hit = region_touches(r, rect) && real;
    if (OUTLINE > 0u) {
      bool within = outline_touches(caster, uint(last), rect);
      hit = hit && within;
    }
    if (SILHOUETTES && STAGE == 0u) {
      float unused;
      Region e = region_of(edges, caster, f, light, w, unused);
      penumbra |= region_touches(e, rect) && real ? 1u : 0u;
    }
    uint m = subgroupBallot(hit).x;
    if (STAGE == 1u && hit) pc.casters.at[out_ + at + uint(bitCount(m & ((1u << lane) - 1u)))] = caster;
    at += uint(bitCount(m));
  }
  if (SILHOUETTES && STAGE == 0u) {
    bool listed = pc.first_parent == 0u && listed_edges_touch(f, light, w, rect);
    penumbra = or_of_all(penumbra | (listed || pc.header.h.crossing > 0u ? 1u : 0u));
    if (lane == 0u && penumbra != 0u) pc.penumbrae.at[list] = 1u;
  }
  if (lane == 0u) pc.counts.at[list] = at;
}
