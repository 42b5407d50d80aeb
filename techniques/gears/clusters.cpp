#include "techniques/gears/clusters.h"

#include <algorithm>

#include "shaders/gears_refit.h"
#include "shaders/gears_walk_tree_any.h"
#include "shaders/gears_walk_tree_grid.h"

namespace penumbra::gears {
namespace {

// Groups that a workgroup does one after the other, where a group has little to do outside the tree:
// launching one costs as much as a few nodes of the tree.
constexpr uint32_t groups_each = 4;

// Room to go on with so many groups, of which some go on as two, while there is room.
uint32_t resume_capacity(uint32_t groups) { return groups + groups / 2 + 1024; }

}  // namespace

void Clusters::setup(FrameState& state) {
  gpu::Device& device = *state.device;
  bound_ = false;
  groups_.setup(device, state.lanes);
  prepare_ = prepare_pipeline(state);
  const gpu::Specialization constants[] = {{0, state.lanes}, {1, wide_lanes}};
  refit_ = gpu::ComputePipeline(device, gears_refit_spv, sizeof(RefitConstants), constants);
  walker_.setup(state, gears_walk_tree_grid_spv, gears_walk_tree_any_spv, sizeof(WalkTreeConstants), 1);
}

void Clusters::build(FrameState& state, const Geometry& geometry, gpu::PassRecorder& passes) {
  passes.host_pass("order_triangles",
                   [&] { order_ = order_triangles(geometry, state.lanes, state.params.triangle_order); });
  passes.finish();
  gpu::ensure(boxes_, *state.device, std::size_t{order_.node_count} * 2 * sizeof(Vec4f), gpu::Memory::device,
              "the box tree");
  state.set_order(order_.slots, order_.tree_slots, passes);
  passes.finish();
  order_.slots = {};
}

void Clusters::bind(const FrameState& state) {
  const VkBufferView boxes[] = {box_texels_.handle()};
  walker_.bind(state, boxes);
  groups_.bind(state.frame_texels.handle(), state.origin_texels.handle(), state.normal_texels.handle());
  bound_ = true;
}

void Clusters::prepare(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes) {
  passes.device_pass("prepare_triangles", [&](gpu::Commands& commands) {
    state.prepare(commands, prepare_, *in.scene_case->geometry, boxes_, order_.first_leaf, order_.leaf_count);
  });
  passes.device_pass("refit", [&](gpu::Commands& commands) {
    // Level by level from the leaves' parents to the root: nodes [first, past).
    for (uint32_t past = order_.first_leaf; past > 0;) {
      const uint32_t first = (past - 1) / state.lanes;
      RefitConstants pc{};
      pc.boxes = boxes_.address();
      pc.first = first;
      pc.count = past - first;
      pc.node_count = order_.node_count;
      commands.dispatch(refit_, pc, groups_for(pc.count, wide_lanes));
      commands.barrier();
      past = first;
    }
  });
}

void Clusters::group(FrameState& state, gpu::PassRecorder& passes) {
  const uint32_t capacity = groups_.capacity(state.width, state.height);
  gpu::ensure(state.slots, *state.device, std::size_t{capacity} * state.lanes * 4, gpu::Memory::device,
              "groups of view samples");
  gpu::ensure(state.resume, *state.device, std::size_t{resume_capacity(capacity)} * 6 * 4,
              gpu::Memory::device, "groups to go on with");
  SampleGroups::Input input;
  input.slots = state.slots.address();
  input.group_count = state.header.address();
  input.width = state.width;
  input.height = state.height;
  input.slack = state.slack;
  input.depth_weight = state.params.depth_weight;
  passes.device_pass("group_samples", [&](gpu::Commands& commands) { groups_.record(commands, input); });
}

void Clusters::walk(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes,
                    Walker::Statistics statistics) {
  WalkTreeConstants pc{};
  pc.light_samples = state.light_samples.address();
  pc.visibility = in.device.visibility->address();
  pc.slots = state.slots.address();
  pc.masks = state.masks_address(in);
  pc.list = state.list.address();
  pc.resume = state.resume.address();
  pc.header = state.header.address();
  pc.groups = group_count_;
  pc.capacity = resume_capacity(groups_.capacity(state.width, state.height));
  pc.split_turns = static_cast<uint32_t>(std::min(state.params.split_turns, state.params.dispatch_turns));
  pc.first_leaf = order_.first_leaf;
  walks_ = walker_.run(state, passes, "walk", group_count_, list_count_, true, statistics,
                       [pc, lanes = state.lanes](gpu::Commands& commands, const gpu::ComputePipeline& p,
                                                 const Walker::Turn& t) mutable {
                         pc.list_begin = t.list_begin;
                         pc.list_end = t.list_end;
                         pc.read_list = t.read_list;
                         // First turns take the groups in an interleaved order, in chunks of 16.
                         const uint64_t chunks = (uint64_t{pc.groups} + 15) / 16;
                         pc.parts = t.resumed && 2 * uint64_t{t.work_groups} <= pc.capacity ? 2 : 1;
                         const uint64_t work = t.resumed ? uint64_t{t.work_groups} * pc.parts : chunks * 16;
                         pc.work_groups = static_cast<uint32_t>(work);
                         const bool little = t.list_end - t.list_begin <= lanes;
                         pc.groups_each = !t.resumed && little ? groups_each : 1;
                         commands.dispatch(p, pc, groups_for(work, pc.groups_each));
                       });
}

void Clusters::render(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes) {
  passes.finish();
  if (state.set_texels(in)) bound_ = false;
  if (box_texels_.set(*state.device, boxes_, "the box tree")) bound_ = false;
  if (!bound_) bind(state);
  state.begin(in, passes);
  prepare(state, in, passes);
  group(state, passes);
  const Header h = state.read_header(passes);
  group_count_ = h.group_count;
  list_count_ = h.list_count;
  walk(state, in, passes, Walker::Statistics::none);
}

void Clusters::count(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes,
                     Counters& counters) {
  const uint32_t walks = walks_;
  const auto run = [&](Walker::Statistics statistics) {
    state.begin(in, passes);
    prepare(state, in, passes);
    group(state, passes);
    state.read_header(passes);
    walk(state, in, passes, statistics);
    return state.read_header(passes);
  };
  const Header walked = run(Walker::Statistics::as_walked), all = run(Walker::Statistics::nothing_skipped);
  const double groups = std::max(1u, group_count_);
  counters["groups"] = static_cast<double>(group_count_);
  counters["nodes_per_group"] = wide(walked.nodes) / groups;
  counters["leaves_per_group"] = wide(walked.leaves) / groups;
  counters["pairs_rasterised"] = wide(walked.pairs);
  counters["total_assignments"] = wide(all.pairs);
  counters["necessary_assignments"] = wide(all.necessary);
  counters["tree_leaves"] = static_cast<double>(order_.leaf_count);
  counters["tree_nodes"] = static_cast<double>(order_.node_count);
  counters["tree_bytes"] = static_cast<double>(boxes_.bytes());
  counters["triangles_outside_tree"] = static_cast<double>(list_count_);
  counters["walk_dispatches"] = static_cast<double>(walks);
}

}  // namespace penumbra::gears
