// Per frame: every triangle in working space, in the order of the tree, and the boxes of its leaves.
//
// A slot holds corners a, b, c; a.w says which triangles the tree or the cells leave to the list: those that cross the
// light's plane (regular grids only; their shadow needs a fourth half-space), and the few far larger than the rest.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/gears/shaders/frame.glsl"
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint SG = 8;
layout(constant_id = 1) const bool REGULAR = true;
#include "techniques/common/shaders/subgroup.glsl"

layout(push_constant) uniform Push { PrepareConstants pc; };

vec3 corner(uint vertex) {
  uint i = vertex * 3u;
  return vec3(pc.positions.at[i], pc.positions.at[i + 1u], pc.positions.at[i + 2u]);
}

void main() {
  uint g = linear_group();
  if (g * SG >= pc.slots) return;
  uint slot = g * SG + gl_SubgroupInvocationID;
  LightBasis light = pc.frame.f.light;
  uint t = slot < pc.slots ? pc.order.at[slot] : no_triangle;
  bool real = t != no_triangle;
  uint i = real ? t * 3u : 0u;
  vec3 a = to_working(light, corner(pc.indices.at[i]));
  vec3 b = to_working(light, corner(pc.indices.at[i + 1u]));
  vec3 c = to_working(light, corner(pc.indices.at[i + 2u]));
  vec3 lo = lower(lower(a, b), c), hi = upper(upper(a, b), c);
  bool before = !REGULAR || hi.z > 0.0;
  bool listed = real && before && (slot >= pc.tree_slots || (REGULAR && lo.z <= 0.0));
  bool in_tree = real && before && !listed;
  if (slot < pc.slots) {
    // What neither the tree nor the list holds lies beyond every view sample.
    const vec3 nowhere = vec3(0.0, 0.0, 1e30);
    bool keep = in_tree || listed;
    pc.triangles.at[slot * 3u] = vec4(keep ? a : nowhere, in_tree ? 0.0 : 1.0);
    pc.triangles.at[slot * 3u + 1u] = vec4(keep ? b : nowhere, 0.0);
    pc.triangles.at[slot * 3u + 2u] = vec4(keep ? c : nowhere, 0.0);
    if (listed) pc.list.at[atomicAdd(pc.header.h.list_count, 1u)] = slot;
  }
  lo = lowest(in_tree ? lo : vec3(1e30));
  hi = highest(in_tree ? hi : vec3(-1e30));
  if (g < pc.leaf_groups && gl_SubgroupInvocationID == 0u) {
    uint n = (pc.first_leaf + g) * 2u;
    pc.boxes.at[n] = vec4(lo, hi.x);
    pc.boxes.at[n + 1u] = vec4(hi.yz, 0.0, 0.0);
  }
}
