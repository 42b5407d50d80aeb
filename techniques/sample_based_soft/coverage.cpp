#include "techniques/sample_based_soft/coverage.h"

#include <algorithm>

#include "shaders/sample_based_soft_cover.h"

namespace penumbra::sample_based_soft {
namespace {

// Casters that one dispatch holds against a list: some drivers end loops after 65,535 turns.
uint32_t part(const FrameState& state, const Casters& casters) {
  return state.lanes * 32768 / (casters.outline_texels() + 1);
}

}  // namespace

void Coverage::setup(const FrameState& state, const Casters& casters) {
  const Params& p = state.params;
  for (uint32_t tiles = 0; tiles < 2; ++tiles)
    for (uint32_t stage = 0; stage < 2; ++stage) {
      const gpu::Specialization constants[] = {{0, state.lanes},
                                               {1, stage},
                                               {2, tiles},
                                               {3, p.fit},
                                               {4, p.skip_empty_lists},
                                               {5, p.far_plane == Params::FarPlane::list},
                                               {6, casters.outline_texels()},
                                               {7, p.restrict_to_penumbra && tiles == 0}};
      cover_[tiles][stage] =
          gpu::ComputePipeline(*state.device, sample_based_soft_cover_spv, sizeof(CoverConstants), constants,
                               std::vector<gpu::ImageUse>(5, gpu::ImageUse::sampled_nearest));
    }
  scan_.setup(*state.device, state.lanes);
}

void Coverage::bind(const FrameState& state, const Casters& casters) {
  const VkImageView views[] = {casters.regions().view(), casters.edges().view(), casters.outlines().view(),
                               casters.triangles().view(), state.frame_texels.view()};
  for (auto& level : cover_)
    for (gpu::ComputePipeline& p : level) p.bind_images(views);
}

uint64_t Coverage::budget(const FrameState& state, const Casters& casters) const {
  // A single list may need every caster.
  return std::max<uint64_t>(uint64_t{static_cast<uint32_t>(state.params.list_budget_mib)} * (1 << 20) / 4,
                            std::max(casters.count(), 1U));
}

void Coverage::dispatch(gpu::Commands& commands, const FrameState& state, const Casters& casters,
                        const SampleLists& lists, bool tiles, uint32_t stage, const Chunk& chunk) const {
  const auto address = [](const gpu::Buffer& b) { return b ? b.address() : 0; };
  CoverConstants pc{};
  pc.frame = state.frame.address();
  pc.header = state.header.address();
  pc.farthest = lists.farthest().address();
  pc.parent_begins = address(tile_begins_);
  pc.parent_counts = address(tile_counts_);
  pc.parents = address(tile_casters_);
  pc.counts = address(tiles ? tile_counts_ : counts_);
  pc.begins = address(tiles ? tile_begins_ : begins_);
  pc.casters = address(tiles ? tile_casters_ : casters_);
  pc.penumbrae = address(penumbrae_);
  pc.listed = casters.list().address();
  pc.first_list = chunk.begin;
  pc.lists = chunk.end - chunk.begin;
  pc.grid_size = state.grid_size();
  pc.chunk_begin = chunk.first_caster;
  pc.caster_count = casters.count();
  pc.list_count = listed_;
  // Over a rectangle of 64 rows, for the interleaving.
  const uint64_t groups = groups_for(pc.lists, 64) * 64;
  const uint32_t step = part(state, casters);
  for (pc.first_parent = 0; pc.first_parent == 0 || pc.first_parent < pc.caster_count;
       pc.first_parent += step) {
    pc.last_parent = std::min(pc.first_parent + step, pc.caster_count);
    commands.dispatch(cover_[tiles][stage], pc, groups);
    commands.barrier();
  }
}

void Coverage::count(FrameState& state, const Casters& casters, const SampleLists& lists,
                     uint32_t group_count, gpu::PassRecorder& passes) {
  const auto words = [&](gpu::Buffer& b, std::size_t count, const char* what) {
    gpu::ensure(b, *state.device, count * 4, gpu::Memory::device, what);
  };
  const uint32_t tiles = state.tiles(), all = state.lists();
  for (gpu::Buffer* b : {&tile_counts_, &tile_begins_}) words(*b, tiles + 1, "casters of the tiles");
  for (gpu::Buffer* b : {&counts_, &begins_}) words(*b, all + 1, "casters of the lists");
  words(penumbrae_, all, "lists in penumbrae");
  words(tile_scratch_, scan_.scratch_bytes(tiles + 1) / 4, "prefix sums");
  words(scratch_, scan_.scratch_bytes(all + 1) / 4, "prefix sums");
  gpu::ensure(scratch_host_, *state.device, 16, gpu::Memory::read_back, "totals");
  const Chunk every_tile{0, tiles, 0, 0, 0}, every_list{0, all - 1, 0, 0, 0};
  passes.device_pass("cover_tiles", [&](gpu::Commands& commands) {
    for (const gpu::Buffer* b : {&tile_counts_, &counts_, &penumbrae_}) commands.fill(*b, 0);
    commands.barrier();
    dispatch(commands, state, casters, lists, true, 0, every_tile);
    scan_.record(commands, tile_counts_, tile_begins_, tile_scratch_, tiles + 1);
    commands.copy(tile_scratch_, scratch_host_, 8);
  });
  listed_ = state.read_header(passes).list_count;
  const uint64_t in_tiles = PrefixScan::total(scratch_host_.view<uint32_t>().data());
  words(tile_casters_, std::max<uint64_t>(in_tiles, 1), "the tiles' casters");
  passes.device_pass("cover_tiles", [&](gpu::Commands& commands) {
    commands.fill(tile_counts_, 0);
    commands.barrier();
    dispatch(commands, state, casters, lists, true, 1, every_tile);
  });
  passes.device_pass("cover_lists", [&](gpu::Commands& commands) {
    dispatch(commands, state, casters, lists, false, 0, every_list);
    scan_.record(commands, counts_, begins_, scratch_, all + 1);
    commands.copy(scratch_, scratch_host_, 8);
  });
  passes.finish();
  total_ = PrefixScan::total(scratch_host_.view<uint32_t>().data());
  plan(state, casters, lists, group_count, passes);
  words(casters_, std::max<uint64_t>(std::min(total_, budget(state, casters)), 1), "the lists' casters");
}

// One chunk where all casters fit the budget; else lists in turn, as many as fit.
void Coverage::plan(const FrameState& state, const Casters& casters, const SampleLists& lists,
                    uint32_t group_count, gpu::PassRecorder& passes) {
  chunks_.clear();
  const uint32_t all = state.lists();
  if (total_ <= budget(state, casters)) {
    chunks_.push_back({0, all, 0, 0, group_count});
    return;
  }
  const std::size_t bytes = std::size_t{all} * 4;
  gpu::ensure(plan_host_, *state.device, 2 * bytes, gpu::Memory::read_back, "casters of the lists");
  passes.device_pass("plan_chunks", [&](gpu::Commands& commands) {
    commands.copy(counts_, plan_host_, bytes);
    commands.copy(lists.first_groups(), plan_host_, bytes, 0, bytes);
  });
  passes.host_pass("plan_chunks", [&] {
    const uint32_t* counts = plan_host_.view<uint32_t>().data();
    const uint32_t* groups = counts + all;
    uint64_t used = 0, offset = 0;
    Chunk chunk;
    const auto close = [&](uint32_t end) {
      chunk.end = end;
      chunk.groups = (end < all ? groups[end] : group_count) - chunk.first_group;
      chunks_.push_back(chunk);
    };
    for (uint32_t c = 0; c < all; offset += counts[c], ++c) {
      if (used > 0 && used + counts[c] > budget(state, casters)) {
        close(c);
        chunk = {c, c, static_cast<uint32_t>(offset), groups[c], 0};
        used = 0;
      }
      used += counts[c];
    }
    close(all);
  });
  passes.finish();
}

void Coverage::write(const FrameState& state, const Casters& casters, const SampleLists& lists,
                     const Chunk& chunk, gpu::PassRecorder& passes) {
  passes.device_pass("cover_lists", [&](gpu::Commands& commands) {
    Chunk part = chunk;
    part.end = std::min(part.end, state.lists() - 1);  // the last list has all casters, and no list of them
    if (part.end <= part.begin) return;
    commands.fill(counts_, 0, uint64_t{part.begin} * 4, uint64_t{part.end - part.begin} * 4);
    commands.barrier();
    dispatch(commands, state, casters, lists, false, 1, part);
  });
}

uint64_t Coverage::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&tile_counts_, &tile_begins_, &tile_casters_, &counts_, &begins_, &casters_,
                               &penumbrae_, &tile_scratch_, &scratch_, &scratch_host_, &plan_host_})
    sum += b->bytes();
  return sum;
}

}  // namespace penumbra::sample_based_soft
