#include "techniques/gears/cells.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "shaders/gears_bin_samples.h"
#include "shaders/gears_bin_triangles.h"
#include "shaders/gears_fit_grid.h"
#include "shaders/gears_walk_cells_any.h"
#include "shaders/gears_walk_cells_grid.h"
#include "techniques/gears/cell_statistics.h"

namespace penumbra::gears {
namespace {

constexpr uint32_t histogram_words = 2 * 1024;
constexpr uint32_t samples_per_lane = 16;  // of bin_samples.comp

}  // namespace

uint32_t Cells::cell_count() const { return grid_size_ * grid_size_ + 1; }

uint64_t Cells::budget(const FrameState& state) const {
  // A single cell may need every triangle.
  return std::max<uint64_t>(uint64_t{static_cast<uint32_t>(state.params.list_budget_mib)} * (1 << 20) / 4,
                            state.slot_count);
}

void Cells::setup(FrameState& state) {
  gpu::Device& device = *state.device;
  bound_ = false;
  grid_size_ = static_cast<uint32_t>(state.params.grid_size);
  prepare_ = prepare_pipeline(state);
  sample_scan_.setup(device, state.lanes, state.lanes);
  triangle_scan_.setup(device, state.lanes);
  const std::vector<gpu::ImageUse> arrays(3, gpu::ImageUse::texels);
  for (uint32_t stage = 0; stage < 2; ++stage) {
    const gpu::Specialization subgroup[] = {{0, state.lanes}, {1, stage}, {2, samples_per_lane}};
    const gpu::Specialization wide[] = {{0, wide_lanes}, {1, stage}, {2, 0}};
    const gpu::Specialization large[] = {{0, wide_lanes}, {1, stage}, {2, 1}};
    fit_[stage] = gpu::ComputePipeline(device, gears_fit_grid_spv, sizeof(FitGridConstants), wide, arrays);
    bin_samples_[stage] =
        gpu::ComputePipeline(device, gears_bin_samples_spv, sizeof(BinSamplesConstants), subgroup, arrays);
    bin_small_[stage] =
        gpu::ComputePipeline(device, gears_bin_triangles_spv, sizeof(BinTrianglesConstants), wide);
    bin_large_[stage] =
        gpu::ComputePipeline(device, gears_bin_triangles_spv, sizeof(BinTrianglesConstants), large);
  }
  walker_.setup(state, gears_walk_cells_grid_spv, gears_walk_cells_any_spv, sizeof(WalkCellsConstants), 0);
}

void Cells::build(FrameState& state, const Geometry& geometry, gpu::PassRecorder& passes) {
  std::vector<uint32_t> all(geometry.triangle_count());
  std::iota(all.begin(), all.end(), 0U);
  state.set_order(all, static_cast<uint32_t>(all.size()), passes);
  passes.finish();
}

void Cells::bind(const FrameState& state) {
  walker_.bind(state, {});
  const VkBufferView arrays[] = {state.frame_texels.handle(), state.origin_texels.handle(),
                                 state.normal_texels.handle()};
  for (gpu::ComputePipeline* p : {&fit_[0], &fit_[1], &bin_samples_[0], &bin_samples_[1]})
    p->bind_texels(arrays);
  bound_ = true;
}

void Cells::allocate(FrameState& state) {
  gpu::Device& device = *state.device;
  const auto words = [&](gpu::Buffer& b, std::size_t count, const char* what) {
    gpu::ensure(b, device, count * 4, gpu::Memory::device, what);
  };
  const std::size_t groups = groups_for(state.pixels(), state.lanes) + cell_count();
  words(histogram_, histogram_words, "the grid's fit");
  for (gpu::Buffer* b : {&sample_counts_, &first_groups_, &triangle_counts_, &offsets_, &placed_})
    words(*b, cell_count(), "counts of the grid's cells");
  words(sample_scratch_, sample_scan_.scratch_bytes(cell_count()) / 4, "prefix sums");
  words(triangle_scratch_, triangle_scan_.scratch_bytes(cell_count()) / 4, "prefix sums");
  gpu::ensure(scratch_host_, device, 16, gpu::Memory::read_back, "totals");
  words(group_cells_, groups, "cells of the groups");
  words(state.slots, groups * state.lanes, "groups of view samples");
  words(state.resume, groups * 3, "groups to go on with");
  words(large_, state.slot_count, "large triangles");
}

void Cells::bin_samples(FrameState& state, const RenderInput&, gpu::PassRecorder& passes) {
  passes.device_pass("fit_grid", [&](gpu::Commands& commands) {
    commands.fill(histogram_, 0);
    commands.barrier();
    FitGridConstants pc{};
    pc.histogram = histogram_.address();
    pc.header = state.header.address();
    pc.width = state.width;
    pc.height = state.height;
    pc.step = std::max(1u, std::max(state.width, state.height) / 256);
    pc.grid_size = grid_size_;
    pc.slack = state.slack;
    const uint64_t points = groups_for(state.width, pc.step) * groups_for(state.height, pc.step);
    commands.dispatch(fit_[0], pc, groups_for(points, wide_lanes));
    commands.barrier();
    commands.dispatch(fit_[1], pc, 1);
  });
  BinSamplesConstants pc{};
  pc.header = state.header.address();
  pc.counts = sample_counts_.address();
  pc.first_groups = first_groups_.address();
  pc.slots = state.slots.address();
  pc.group_cells = group_cells_.address();
  pc.pixels = state.pixels();
  pc.grid_size = grid_size_;
  pc.slack = state.slack;
  const uint64_t groups = groups_for(state.pixels(), uint64_t{state.lanes} * samples_per_lane);
  passes.device_pass("bin_samples", [&](gpu::Commands& commands) {
    commands.fill(sample_counts_, 0);
    commands.fill(state.slots, no_triangle);
    commands.barrier();
    commands.dispatch(bin_samples_[0], pc, groups);
    commands.barrier();
    sample_scan_.record(commands, sample_counts_, first_groups_, sample_scratch_, cell_count());
    commands.fill(sample_counts_, 0);
    commands.barrier();
    commands.dispatch(bin_samples_[1], pc, groups);
  });
}

void Cells::bin_triangles(const FrameState& state, gpu::Commands& commands, uint32_t stage, uint32_t large,
                          const Chunk& chunk) const {
  BinTrianglesConstants pc{};
  pc.frame = state.frame.address();
  pc.header = state.header.address();
  pc.triangles = state.triangles.address();
  pc.counts = (stage == 0 ? triangle_counts_ : placed_).address();
  pc.offsets = offsets_.address();
  pc.assigned = assigned_ ? assigned_.address() : 0;
  pc.large = large_.address();
  pc.slots = state.slot_count;
  pc.grid_size = grid_size_;
  pc.large_count = large;
  pc.cell_begin = chunk.begin;
  pc.cell_end = chunk.end;
  pc.chunk_begin = chunk.first_offset;
  if (large == 0)
    commands.dispatch(bin_small_[stage], pc, groups_for(state.slot_count, wide_lanes));
  else
    commands.dispatch(bin_large_[stage], pc, groups_for(uint64_t{large} * (grid_size_ + 1), wide_lanes));
}

void Cells::count_triangles(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes) {
  passes.device_pass("prepare_triangles", [&](gpu::Commands& commands) {
    state.prepare(commands, prepare_, *in.scene_case->geometry, state.triangles, 0, 0);
  });
  passes.device_pass("count_triangles", [&](gpu::Commands& commands) {
    commands.fill(triangle_counts_, 0);
    commands.barrier();
    bin_triangles(state, commands, 0, 0, {});
    commands.copy(sample_scratch_, scratch_host_, 8);
  });
  const Header h = state.read_header(passes);
  group_count_ = static_cast<uint32_t>(PrefixScan::total(scratch_host_.view<uint32_t>().data()));
  list_count_ = h.list_count;
  large_count_ = h.large_count;
  passes.device_pass("count_triangles", [&](gpu::Commands& commands) {
    if (large_count_ > 0) bin_triangles(state, commands, 0, large_count_, {});
    commands.barrier();
    triangle_scan_.record(commands, triangle_counts_, offsets_, triangle_scratch_, cell_count());
    commands.copy(triangle_scratch_, scratch_host_, 8);
  });
  passes.finish();
  assignments_ = PrefixScan::total(scratch_host_.view<uint32_t>().data());
}

// One chunk where all lists fit the budget; else cells in turn, as many as fit.
void Cells::plan_chunks(FrameState& state, gpu::PassRecorder& passes) {
  chunks_.clear();
  if (assignments_ <= budget(state)) {
    chunks_.push_back({0, cell_count(), 0, 0, group_count_});
    return;
  }
  const std::size_t bytes = std::size_t{cell_count()} * 4;
  gpu::ensure(counts_host_, *state.device, 2 * bytes, gpu::Memory::read_back, "counts of the grid's cells");
  passes.device_pass("plan_chunks", [&](gpu::Commands& commands) {
    commands.copy(triangle_counts_, counts_host_, bytes);
    commands.copy(first_groups_, counts_host_, bytes, 0, bytes);
  });
  passes.host_pass("plan_chunks", [&] {
    const uint32_t* counts = counts_host_.view<uint32_t>().data();
    const uint32_t* groups = counts + cell_count();
    uint64_t used = 0, offset = 0;
    Chunk chunk;
    const auto close = [&](uint32_t end) {
      chunk.end = end;
      chunk.groups = (end < cell_count() ? groups[end] : group_count_) - chunk.first_group;
      chunks_.push_back(chunk);
    };
    for (uint32_t c = 0; c < cell_count(); offset += counts[c], ++c) {
      if (used > 0 && used + counts[c] > budget(state)) {
        close(c);
        chunk = {c, c, static_cast<uint32_t>(offset), groups[c], 0};
        used = 0;
      }
      used += counts[c];
    }
    close(cell_count());
  });
  passes.finish();
}

void Cells::walk_chunks(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes,
                        Walker::Statistics statistics) {
  WalkCellsConstants pc{};
  pc.light_samples = state.light_samples.address();
  pc.visibility = in.device.visibility->address();
  pc.slots = state.slots.address();
  pc.masks = state.masks_address(in);
  pc.list = state.list.address();
  pc.group_cells = group_cells_.address();
  pc.counts = triangle_counts_.address();
  pc.offsets = offsets_.address();
  pc.assigned = assigned_.address();
  pc.resume = state.resume.address();
  pc.header = state.header.address();
  pc.groups = group_count_;
  walks_ = 0;
  for (const Chunk& chunk : chunks_) {
    if (chunk.groups == 0) continue;
    passes.device_pass("assign_triangles", [&](gpu::Commands& commands) {
      commands.fill(placed_, 0);
      commands.barrier();
      bin_triangles(state, commands, 1, 0, chunk);
      if (large_count_ > 0) bin_triangles(state, commands, 1, large_count_, chunk);
    });
    pc.first_group = chunk.first_group;
    pc.chunk_begin = chunk.first_offset;
    walks_ += walker_.run(
        state, passes, "walk", chunk.groups, list_count_, true, statistics,
        [pc](gpu::Commands& commands, const gpu::ComputePipeline& p, const Walker::Turn& t) mutable {
          pc.work_groups = t.work_groups;
          pc.list_begin = t.list_begin;
          pc.list_end = t.list_end;
          pc.read_list = t.read_list;
          commands.dispatch(p, pc, t.work_groups);
        });
  }
}

void Cells::render(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes) {
  allocate(state);
  passes.finish();
  if (state.set_texels(in)) bound_ = false;
  if (!bound_) bind(state);
  state.begin(in, passes);
  bin_samples(state, in, passes);
  count_triangles(state, in, passes);
  plan_chunks(state, passes);
  gpu::ensure(assigned_, *state.device, std::max<uint64_t>(std::min(assignments_, budget(state)), 1) * 4,
              gpu::Memory::device, "the cells' lists of triangles");
  walk_chunks(state, in, passes, Walker::Statistics::none);
}

void Cells::count(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes, Counters& counters) {
  const uint32_t walks = walks_;
  const auto recount = [&](Walker::Statistics statistics) {
    state.begin(in, passes);
    bin_samples(state, in, passes);
    count_triangles(state, in, passes);
    plan_chunks(state, passes);
    walk_chunks(state, in, passes, statistics);
    return state.read_header(passes);
  };
  const Header walked = recount(Walker::Statistics::as_walked),
               all = recount(Walker::Statistics::nothing_skipped);
  CellCounts counts;
  counts.samples.resize(cell_count());
  counts.triangles.resize(cell_count());
  gpu::download(passes, "read_counts", sample_counts_, counts.samples.data(), counts.samples.size() * 4);
  gpu::download(passes, "read_counts", triangle_counts_, counts.triangles.data(),
                counts.triangles.size() * 4);
  passes.finish();
  add_cell_counters(counts, counters);
  add_area_counters(in.scene_case->frame->geometry, state.constants, all, counters);
  counters["pairs_rasterised"] = wide(walked.pairs);
  counters["necessary_assignments"] = wide(all.necessary);
  counters["assignments_to_cells"] = static_cast<double>(assignments_);
  counters["triangles_outside_grid"] = static_cast<double>(list_count_);
  counters["chunks"] = static_cast<double>(chunks_.size());
  counters["walk_dispatches"] = static_cast<double>(walks);
}

uint64_t Cells::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&histogram_, &sample_counts_, &first_groups_, &triangle_counts_, &offsets_,
                               &placed_, &sample_scratch_, &triangle_scratch_, &scratch_host_, &counts_host_,
                               &group_cells_, &large_, &assigned_})
    sum += b->bytes();
  return sum;
}

}  // namespace penumbra::gears
