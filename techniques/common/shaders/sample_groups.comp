// Groups of SG view samples that lie close together: each tile of 8 SG pixels is cut by a k-d tree of three levels.
//
// One subgroup does one tile, a lane holds eight of its pixels. A level finds the longest axis of each part, ranks all
// samples along it by counting the smaller ones (arithmetic is cheap here, memory is not) and cuts at the middle.
// Samples that no light sample can reach are left out; the last group of a tile is filled up with no_sample.
//
// IN_LISTS: view samples are in lists already, each in groups of its own; runs of eight groups of a list are rearranged
// where they are.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define PENUMBRA_COMPUTE
#include "gpu/shaders/common.glsl"
#include "techniques/common/shaders/buffers.glsl"
#include "techniques/common/shaders/light_basis.glsl"
#include "techniques/common/shaders/constants.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 1) const uint TILE_WIDTH = 8;     // TILE_WIDTH * tile height = PER_LANE SG
layout(constant_id = 2) const uint TILE_HEIGHT = 8;
layout(constant_id = 3) const uint LEVELS = 3;
layout(constant_id = 4) const bool IN_LISTS = false;
#include "techniques/common/shaders/subgroup.glsl"
const uint PER_LANE = 1u << LEVELS;   // pixels of a tile that a lane holds

layout(set = 0, binding = 0) uniform Texels light_texels;    // a LightBasis
layout(set = 0, binding = 1) uniform Texels origin_texels;   // per pixel: P' (w = 0: no view sample)
layout(set = 0, binding = 2) uniform Texels normal_texels;   // per pixel: Ng
layout(push_constant) uniform Push { SampleGroupsConstants pc; };

const uint no_sample = 0xffffffffu;
const int inactive = 0x7fffffff;

void main() {
  uint tile = linear_group();
  if (tile >= pc.tiles) return;
  uint lane = gl_SubgroupInvocationID;
  uint taken = 0u;   // in lists: view samples of the run
  if (IN_LISTS) {
    uint list = pc.group_lists.at[tile], before = tile - pc.first_groups.at[list];
    if (before % PER_LANE != 0u) return;
    taken = min(pc.lengths.at[list] - before * SG, PER_LANE * SG);
    if (taken <= SG) return;
  }
  LightBasis light = light_basis(light_texels);
  uvec2 corner = uvec2(tile % pc.tiles_x, tile / pc.tiles_x) * uvec2(TILE_WIDTH, TILE_HEIGHT);

  vec3 at[PER_LANE];
  uint pixel[PER_LANE];
  int key[PER_LANE];
  uint rank[PER_LANE];
  uint count = 0u;
  [[unroll]] for (uint k = 0u; k < PER_LANE; k++) {
    uint q = k * SG + lane;
    uvec2 xy = corner + uvec2(q % TILE_WIDTH, q / TILE_WIDTH);
    bool inside = xy.x < pc.width && xy.y < pc.height;
    pixel[k] = inside ? xy.y * pc.width + xy.x : 0u;
    if (IN_LISTS) pixel[k] = pc.slots.at[tile * SG + min(q, taken - 1u)];
    vec4 o = texel(origin_texels, pixel[k]);
    vec3 n = texel(normal_texels, pixel[k]).xyz;
    vec3 w = to_working(light, o.xyz);
    bool active_ = IN_LISTS ? q < taken : inside && reachable(light, o, n, pc.slack);
    at[k] = vec3(w.xy, w.z * pc.depth_weight);
    key[k] = active_ ? 0 : inactive;
    rank[k] = 0u;
    count += active_ ? 1u : 0u;
  }
  count = sum_of_all(count);
  if (count == 0u) return;

  [[unroll]] for (uint level = 0u; level < LEVELS; level++) {
    const uint parts = 1u << level;
    const uint part_size = (PER_LANE * SG) >> level;
    int next[PER_LANE];
    uint part[PER_LANE];
    [[unroll]] for (uint k = 0u; k < PER_LANE; k++) {
      next[k] = inactive;
      part[k] = key[k] != inactive ? rank[k] / part_size : parts;
    }
    [[unroll]] for (uint s = 0u; s < parts; s++) {
      vec3 lo = vec3(1e30), hi = vec3(-1e30);
      [[unroll]] for (uint k = 0u; k < PER_LANE; k++) {
        bool mine = part[k] == s;
        lo = mix(lo, lower(lo, at[k]), bvec3(mine));
        hi = mix(hi, upper(hi, at[k]), bvec3(mine));
      }
      lo = lowest(lo);
      hi = highest(hi);
      vec3 extent = hi - lo;
      bool x = extent.x >= extent.y && extent.x >= extent.z, y = !x && extent.y >= extent.z;
      float from = x ? lo.x : y ? lo.y : lo.z, size = x ? extent.x : y ? extent.y : extent.z;
      float scale = 262143.0 / upper(size, 1e-30);
      [[unroll]] for (uint k = 0u; k < PER_LANE; k++) {
        bool mine = part[k] == s;
        float v = x ? at[k].x : y ? at[k].y : at[k].z;
        // Part, place along its axis (18 bits), index: unique, so that ranks are a permutation.
        int bits = int(s << 26u) | int(clamp((v - from) * scale, 0.0, 262143.0)) << 8 | int(k * SG + lane);
        next[k] = mine ? bits : next[k];
      }
    }
    [[unroll]] for (uint k = 0u; k < PER_LANE; k++) {
      key[k] = next[k];
      rank[k] = 0u;
    }
    for (uint l = 0u; l < SG; l++) {
      [[unroll]] for (uint m = 0u; m < PER_LANE; m++) {
        int other = subgroupShuffle(key[m], l);
        [[unroll]] for (uint k = 0u; k < PER_LANE; k++) rank[k] += other < key[k] ? 1u : 0u;
      }
    }
  }

  if (IN_LISTS) {
    [[unroll]] for (uint k = 0u; k < PER_LANE; k++)
      if (key[k] != inactive) pc.slots.at[tile * SG + rank[k]] = pixel[k];
    return;
  }
  uint groups = (count + SG - 1u) / SG, base = 0u;
  if (lane == 0u) base = atomicAdd(pc.group_count.at[0], groups);
  base = subgroupShuffle(base, 0u) * SG;
  [[unroll]] for (uint k = 0u; k < PER_LANE; k++)
    if (key[k] != inactive) pc.slots.at[base + rank[k]] = pixel[k];
  if (count + lane < groups * SG) pc.slots.at[base + count + lane] = no_sample;
}
