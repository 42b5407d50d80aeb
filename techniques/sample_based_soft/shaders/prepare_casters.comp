// Per frame: every triangle that casts, in working space, and the regions of the casters: of blocks of SG triangles, or
// of each triangle.
//
// A slot holds corners a, b, c; a.w is 0 for triangles in blocks, 1 for those that the blocks leave to the list: the few
// far larger than the rest and, on a regular grid of light samples, those that cross the light's plane (their shadow
// needs a fourth half-space). b.w says which of its edges may be silhouettes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "techniques/sample_based_soft/shaders/frame.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 1) const bool REGULAR = true;
layout(constant_id = 2) const bool BLOCKS = true;
layout(constant_id = 3) const bool CULL_BACK_FACES = true;
layout(constant_id = 4) const bool SILHOUETTES = true;
layout(constant_id = 5) const bool BALL = false;         // the light is bounded by the unit sphere, else by a rectangle
#include "techniques/common/shaders/subgroup.glsl"
#include "techniques/sample_based_soft/shaders/region.glsl"
layout(push_constant) uniform Push { CastersConstants pc; };
#include "techniques/sample_based_soft/shaders/corners.glsl"
#include "techniques/sample_based_soft/shaders/outline.glsl"

// Bits of the triangle's edges that are silhouettes for some point of the light [Sintorn2008, sec. 4.3].
uint silhouettes(uint t) {
  uint own = pc.facing.at[t], bits = 0u;
  [[unroll]] for (uint k = 0u; k < 3u; k++) {
    uint other = pc.neighbours.at[3u * t + k];
    uint facing = other != no_triangle ? pc.facing.at[other] : 0u;
    bits |= own == 0u || own != facing ? 1u << k : 0u;
  }
  return bits;
}

// The whole scene is on the side that the light sees, as with a ground: nothing is behind that could be hidden. What is
// behind by no more than rounding is nearer than the offset of P'.
bool hides_nothing(FrameConstants f, uint facing, vec3 a, vec3 b, vec3 c) {
  vec3 n = cross(b - a, c - a) * (facing == 2u ? -1.0 : 1.0);
  float reach = 0.0;
  [[unroll]] for (uint k = 0u; k < 3u; k++) reach += abs(dot(n, f.scene_sides[k].xyz));
  float least = dot(n, f.scene_middle.xyz - a) - reach;
  return facing != 0u && least > -4.0 * f.pad * length(n);
}

void store_box(Vec4s boxes, uint at, vec3 lo, vec3 hi, float last) {
  boxes.at[2u * at] = vec4(lo, hi.x);
  boxes.at[2u * at + 1u] = vec4(hi.yz, last, 0.0);
}

void main() {
  uint g = linear_group();
  if (g * SG >= pc.slots) return;
  uint slot = g * SG + gl_SubgroupInvocationID;
  FrameConstants f = caster_constants();
  uint t = slot < pc.slots ? pc.order.at[slot] : no_triangle;
  bool real = t != no_triangle;
  t = real ? t : 0u;
  vec3 a = corner(f.light, 3u * t), b = corner(f.light, 3u * t + 1u), c = corner(f.light, 3u * t + 2u);
  vec3 lo = lower(lower(a, b), c), hi = upper(upper(a, b), c);
  uint facing = CULL_BACK_FACES || SILHOUETTES ? pc.facing.at[t] : 0u;
  bool dark = CULL_BACK_FACES && facing == 2u && (pc.closed.at[t >> 5u] >> (t & 31u) & 1u) != 0u;
  bool casts = real && (!REGULAR || hi.z > 0.0) && !dark;
  bool listed = casts && (slot >= pc.block_slots || (REGULAR && lo.z <= 0.0));
  bool in_block = casts && !listed;
  uint edges = SILHOUETTES && casts ? silhouettes(t) : 0u;
  if (SILHOUETTES) edges = hides_nothing(f, facing, a, b, c) ? 0u : edges;
  if (SILHOUETTES && casts && facing == 0u && lo.z <= f.light_hi.z + f.near) atomicAdd(pc.header.h.crossing, 1u);
  if (slot < pc.slots) {
    // What neither the blocks nor the list holds lies beyond every view sample.
    const vec3 nowhere = vec3(0.0, 0.0, 1e30);
    pc.triangles.at[slot * 3u] = vec4(casts ? a : nowhere, in_block ? 0.0 : 1.0);
    pc.triangles.at[slot * 3u + 1u] = vec4(casts ? b : nowhere, float(edges));
    pc.triangles.at[slot * 3u + 2u] = vec4(casts ? c : nowhere, 0.0);
    if (listed) pc.list.at[atomicAdd(pc.header.h.list_count, 1u)] = slot;
  }
  uint casting = sum_of_all(casts ? 1u : 0u), silhouette_edges = sum_of_all(uint(bitCount(edges)));
  if (gl_SubgroupInvocationID == 0u && casting > 0u) atomicAdd(pc.header.h.casters, casting);
  if (gl_SubgroupInvocationID == 0u && silhouette_edges > 0u) atomicAdd(pc.header.h.silhouettes, silhouette_edges);
  lo = in_block ? lo - f.pad : vec3(1e30);
  hi = in_block ? hi + f.pad : vec3(-1e30);
  bool ab = (edges & 1u) != 0u, bc = (edges & 2u) != 0u, ca = (edges & 4u) != 0u;
  vec3 edge_lo = vec3(1e30), edge_hi = vec3(-1e30);
  if (SILHOUETTES) {
    edge_lo = lower(lower(ab || ca ? a : edge_lo, ab || bc ? b : edge_lo), bc || ca ? c : edge_lo);
    edge_hi = upper(upper(ab || ca ? a : edge_hi, ab || bc ? b : edge_hi), bc || ca ? c : edge_hi);
    edge_lo = in_block ? edge_lo - f.pad : vec3(1e30);
    edge_hi = in_block ? edge_hi + f.pad : vec3(-1e30);
  }
  if (BLOCKS) {
    lo = lowest(lo);
    hi = highest(hi);
    edge_lo = lowest(edge_lo);
    edge_hi = highest(edge_hi);
    if (slot >= pc.block_slots || gl_SubgroupInvocationID != 0u) return;
    store_box(pc.regions, g, lo, hi, 0.0);
    if (SILHOUETTES) store_box(pc.edges, g, edge_lo, edge_hi, 0.0);
  } else if (slot < pc.block_slots) {
    uint sides = outline(f, a, b, c, in_block, slot);
    store_box(pc.regions, slot, lo, hi, float(sides));
    if (SILHOUETTES) store_box(pc.edges, slot, edge_lo, edge_hi, 0.0);
  }
}
