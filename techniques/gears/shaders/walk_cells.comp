// assignment: triangles. A group of view samples of one grid cell goes through the cell's list of triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "techniques/gears/shaders/walk.glsl"

layout(set = 0, binding = 4) uniform FrameBlock { FrameConstants frame; };
layout(push_constant) uniform Push { WalkCellsConstants pc; };

// Goes on after `done` triangles; returns how many are done, or 0xffffffff when all are.
uint walk(uint cell, uint done) {
  uint begin = pc.offsets.at[cell] - pc.chunk_begin, count = pc.counts.at[cell];
  bool full = false;
  if (done < count) {
    do {
      uint mine = done + gl_SubgroupInvocationID;
      bool wanted = mine < count;
      rasterise_slots(wanted ? pc.assigned.at[begin + mine] : 0u, wanted, false);
      done += SG;
      turns++;
      full = all_blocked();
      if (COUNTING != 0u) leaves++;
    } while (done < count && !full && turns < TURN_LIMIT);
  }
  return done < count && !full ? done : 0xffffffffu;
}

void main() {
  uint n = linear_group();
  if (n >= pc.work_groups) return;
  uint g = RESUMED ? pc.resume.at[pc.read_list * pc.groups + n] : pc.first_group + n;
  FrameConstants f = frame;
  begin_group(fetch_group(g, every_lane, pc.slots, pc.masks), f, pc.light_samples);
  if (BEGIN)
    block_horizon(position, normal, f);
  else
    load_mask(pc.masks);
  if (LIST) do_list(pc.list, pc.list_begin, pc.list_end);
  if (WALK) {
    uint next = 0xffffffffu;
    if (!all_blocked()) next = walk(pc.group_cells.at[g], RESUMED ? pc.resume.at[2u * pc.groups + g] : 0u);
    if (next != 0xffffffffu && gl_SubgroupInvocationID == 0u) {
      pc.resume.at[(1u - pc.read_list) * pc.groups + atomicAdd(pc.header.h.resume_count, 1u)] = g;
      pc.resume.at[2u * pc.groups + g] = next;
    }
  }
  store_mask(pc.masks);
  store_visibility(pc.visibility);
  add_statistics(pc.header);
}
