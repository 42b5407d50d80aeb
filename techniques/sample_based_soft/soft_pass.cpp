#include "techniques/sample_based_soft/soft_pass.h"

#include <algorithm>
#include <bit>

#include "shaders/sample_based_soft_split_groups.h"
#include "shaders/sample_based_soft_walk_any.h"
#include "shaders/sample_based_soft_walk_grid.h"

namespace penumbra::sample_based_soft {
namespace {

constexpr int most_words_any = 32, most_words_grid = 128;

uint32_t u(int x) { return static_cast<uint32_t>(x); }

// Words of the mask that one turn of the row loop fills: two rows, where a row takes 32 bits or more.
uint32_t band_words(const MaskLayout& m) { return m.pitch == 64 ? 4 : m.pitch == 32 ? 2 : 1; }

// Loop turns that one triangle can take.
uint32_t triangle_turns(const FrameState& state) {
  const MaskLayout& m = state.light.layout;
  if (m.grid) return u(m.pitch == 64 ? m.rows : m.words) + 2;
  // Clusters of 16 samples, a turn for each and one per so many of their samples as there are lanes.
  return u(words_per_pass(m)) * 2 * (16 / state.lanes + 3) + 4;
}

}  // namespace

int words_per_pass(const MaskLayout& m) {
  return std::min(m.words, m.grid ? most_words_grid : most_words_any);
}

void SoftPass::setup(const FrameState& state, const Casters& casters) {
  blocks_ = casters.blocks();
  pipelines_.clear();
  split_ = gpu::ComputePipeline(*state.device, sample_based_soft_split_groups_spv, sizeof(SplitConstants));
  for (const bool hard : {false, true})
    if (!hard || state.params.restrict_to_penumbra)
      pipeline(state, {true, true, true, false, hard, Statistics::none});
}

void SoftPass::bind(const FrameState& state, const Casters& casters, const PlaneTable& table) {
  views_ = {state.frame_texels.view(),         state.view_texels.origin.view(),
            state.view_texels.position.view(), state.view_texels.normal.view(),
            casters.triangles().view(),        casters.regions().view()};
  if (!state.light.layout.grid) views_.insert(views_.end(), {state.sample_texels.view(), table.view()});
  for (auto& [variant, p] : pipelines_) p.bind_images(views_);
}

const gpu::ComputePipeline& SoftPass::pipeline(const FrameState& state, const Variant& v) {
  auto& p = pipelines_[v];
  if (p) return p;
  const MaskLayout& m = state.light.layout;
  const Params& params = state.params;
  std::vector<gpu::Specialization> constants = {{0, state.lanes},
                                                {4, u(words_per_pass(m))},
                                                {6, v.resumed},
                                                {7, blocks_},
                                                {8, u(params.dispatch_turns)},
                                                {9, static_cast<uint32_t>(v.statistics)},
                                                {10, v.begin},
                                                {11, v.list},
                                                {12, v.walk},
                                                {13, state.walk_resolves() ? u(m.samples) : 0},
                                                {16, v.hard},
                                                {17, params.restrict_to_penumbra},
                                                {18, params.cull_supporting_planes},
                                                {19, u(m.words)},
                                                {20, static_cast<uint32_t>(m.move)},
                                                {21, state.transparent()},
                                                {22, std::bit_cast<uint32_t>(1 - params.transparency)},
                                                {23, u(m.samples)}};
  if (m.grid) {
    constants.insert(constants.end(),
                     {{1, u(m.columns)}, {2, u(m.rows)}, {3, u(m.pitch)}, {14, band_words(m)}});
  } else {
    const bool table = params.half_spaces == Params::HalfSpaces::table;
    constants.insert(
        constants.end(),
        {{24, m.clustered}, {1, u(m.samples)}, {5, table ? u(params.table_size) : 0}, {15, entry_texels(m)}});
  }
  const gpu::Spirv code =
      m.grid ? gpu::Spirv(sample_based_soft_walk_grid_spv) : gpu::Spirv(sample_based_soft_walk_any_spv);
  p = gpu::ComputePipeline(*state.device, code, sizeof(WalkConstants), constants,
                           std::vector<gpu::ImageUse>(m.grid ? 6 : 8, gpu::ImageUse::sampled_nearest));
  if (!views_.empty()) p.bind_images(views_);
  return p;
}

void SoftPass::run(FrameState& state, const RenderInput& in, const Casters& casters, const SampleLists& lists,
                   const Coverage& coverage, const Chunk& chunk, Statistics statistics,
                   gpu::PassRecorder& passes) {
  if (chunk.groups == 0) return;
  const std::size_t capacity = lists.group_capacity(state);
  gpu::ensure(resume_, *state.device, capacity * 3 * 4, gpu::Memory::device, "groups to go on with");
  WalkConstants pc{};
  pc.visibility = state.transparent() ? state.through.address() : in.device.visibility->address();
  pc.slots = lists.slots().address();
  pc.masks = state.masks_address(in);
  pc.list = casters.list().address();
  pc.group_lists = lists.group_lists().address();
  pc.counts = coverage.counts().address();
  pc.begins = coverage.begins().address();
  pc.casters = coverage.casters().address();
  pc.resume = resume_.address();
  pc.header = state.header.address();
  pc.capacity = static_cast<uint32_t>(capacity);
  pc.chunk_begin = chunk.first_caster;
  pc.caster_count = casters.count();
  pc.outside_list = state.lists() - 1;
  if (!state.params.restrict_to_penumbra)
    return walk(state, pc, {chunk.groups, chunk.first_group, false}, coverage.listed(), statistics, passes);
  gpu::ensure(work_, *state.device, capacity * 2 * 4, gpu::Memory::device, "groups in and out of penumbrae");
  SplitConstants split{};
  split.header = state.header.address();
  split.group_lists = lists.group_lists().address();
  split.penumbrae = coverage.penumbrae().address();
  split.work = work_.address();
  split.first_group = chunk.first_group;
  split.groups = chunk.groups;
  split.capacity = pc.capacity;
  passes.device_pass("split_groups", [&](gpu::Commands& commands) {
    commands.fill(state.header, 0, offsetof(Header, hard_count), 8);
    commands.barrier();
    commands.dispatch(split_, split, groups_for(split.groups, wide_lanes));
  });
  const Header h = state.read_header(passes);
  hard_groups_ += h.hard_count;
  pc.work = work_.address();
  walk(state, pc, {h.soft_count, 0, false}, coverage.listed(), statistics, passes);
  walk(state, pc, {h.hard_count, pc.capacity, true}, coverage.listed(), statistics, passes);
}

// A pass per so many words of the masks. In each: first what stays outside the blocks, then the lists'
// casters, then again for the groups that used up their loop turns, until none is left.
void SoftPass::walk(FrameState& state, WalkConstants pc, const Part& part, uint32_t listed,
                    Statistics statistics, gpu::PassRecorder& passes) {
  if (part.groups == 0) return;
  const auto turn = [&](Variant v, uint32_t first, uint32_t groups) {
    v.hard = part.hard, v.statistics = statistics;
    const gpu::ComputePipeline& p = pipeline(state, v);
    pc.first_group = first;
    pc.work_groups = groups;
    passes.device_pass(part.hard ? "hard_shadows" : "soft_shadows", [&](gpu::Commands& commands) {
      commands.fill(state.header, 0, offsetof(Header, resume_count), 4);
      commands.barrier();
      // First turns take the groups in an interleaved order, over a rectangle of 64 rows.
      commands.dispatch(p, pc, v.resumed ? groups : groups_for(groups, 1024) * 1024);
    });
    ++dispatches_;
  };
  constexpr uint32_t most_turns = 20000;
  const uint32_t chunk_turns = state.lanes * triangle_turns(state) + 2;
  const uint32_t step = std::max(most_turns / chunk_turns, 1U) * state.lanes;
  const uint32_t words = u(state.light.layout.words), per_pass = u(words_per_pass(state.light.layout));
  for (pc.first_word = 0; pc.first_word < words; pc.first_word += per_pass) {
    const bool merge = listed <= step;
    for (uint32_t from = 0; !merge && from < listed; from += step) {
      pc.list_begin = from, pc.list_end = std::min(from + step, listed);
      turn({from == 0, true, false, false, false, statistics}, part.first, part.groups);
    }
    pc.list_begin = 0, pc.list_end = listed;
    turn({merge, merge && listed > 0, true, false, false, statistics}, part.first, part.groups);
    for (pc.read_list = 1;; pc.read_list ^= 1) {
      const uint32_t left = state.read_header(passes).resume_count;
      if (left == 0) break;
      turn({false, false, true, true, false, statistics}, 0, left);
    }
  }
}

}  // namespace penumbra::sample_based_soft
