#include "techniques/gears/walker.h"

#include <algorithm>
#include <cstddef>

namespace penumbra::gears {
namespace {

// Loop turns that a kernel may use beyond its limit before it looks at it again; see dispatch_turns and
// walk.glsl.
constexpr uint32_t turns_between_looks = 30000;

// Words of the mask that one turn of the row loop fills. Large triangles reach over many rows.
uint32_t band_words(const MaskLayout& m, bool small_triangles) {
  const int most = m.pitch >= 32 ? (small_triangles || m.pitch == 64 ? 4 : 8) : (small_triangles ? 1 : 2);
  return static_cast<uint32_t>(std::min(m.words, most));
}

}  // namespace

// Loop turns that rasterising one triangle can take.
uint32_t Walker::triangle_turns(const FrameState& state) const {
  const MaskLayout& m = state.layout;
  if (m.grid) return static_cast<uint32_t>(m.pitch == 64 ? m.rows : m.words) + 2;
  const uint32_t samples = static_cast<uint32_t>(std::min(m.samples, 32));
  return static_cast<uint32_t>(m.words) * (samples + samples / state.lanes + 3) + 2;
}

uint32_t Walker::leaf_batch(const FrameState& state) const {
  const uint32_t fit = turns_between_looks / (state.lanes * triangle_turns(state) + 2);
  // A batch may overshoot by the leaves of one parent.
  const uint32_t most = fit > 2 * state.lanes ? fit - state.lanes : 1;
  return std::clamp(static_cast<uint32_t>(state.params.leaf_batch), 1u, most);
}

void Walker::setup(const FrameState& state, gpu::Spirv grid, gpu::Spirv any, uint32_t push_bytes,
                   uint32_t more_arrays) {
  grid_ = grid;
  any_ = any;
  push_bytes_ = push_bytes;
  arrays_ = 4 + more_arrays;
  pipelines_.clear();
  views_.clear();
  pipeline(state, {true, true, true, false, Statistics::none});
}

void Walker::bind(const FrameState& state, std::span<const VkBufferView> more) {
  views_ = {state.origin_texels.handle(), state.position_texels.handle(), state.normal_texels.handle(),
            state.triangle_texels.handle()};
  views_.insert(views_.end(), more.begin(), more.end());
  for (auto& [variant, p] : pipelines_) bind(state, p);
}

void Walker::bind(const FrameState& state, gpu::ComputePipeline& pipeline) const {
  pipeline.bind_texels(views_);
  pipeline.bind_block(state.frame);
}

const gpu::ComputePipeline& Walker::pipeline(const FrameState& state, const Variant& v) {
  auto& p = pipelines_[v];
  if (p) return p;
  const MaskLayout& m = state.layout;
  const auto u = [](int x) { return static_cast<uint32_t>(x); };
  std::vector<gpu::Specialization> constants = {{0, state.lanes},
                                                {4, u(m.words)},
                                                {6, v.resumed},
                                                {7, leaf_batch(state)},
                                                {8, u(state.params.dispatch_turns)},
                                                {9, static_cast<uint32_t>(v.statistics)},
                                                {10, v.begin},
                                                {11, v.list},
                                                {12, v.walk},
                                                {15, state.small_triangles},
                                                {13, state.walk_resolves() ? u(m.samples) : 0},
                                                {20, static_cast<uint32_t>(m.move)}};
  if (m.grid) {
    constants.insert(
        constants.end(),
        {{1, u(m.columns)}, {2, u(m.rows)}, {3, u(m.pitch)}, {14, band_words(m, state.small_triangles)}});
  } else {
    constants.insert(constants.end(), {{1, u(m.samples)}, {5, m.infinite}});
  }
  std::vector<gpu::ImageUse> uses(arrays_, gpu::ImageUse::texels);
  uses.push_back(gpu::ImageUse::uniform_block);
  p = gpu::ComputePipeline(*state.device, m.grid ? grid_ : any_, push_bytes_, constants, uses);
  if (!views_.empty()) bind(state, p);
  return p;
}

uint32_t Walker::run(FrameState& state, gpu::PassRecorder& passes, const char* name, uint32_t groups,
                     uint32_t list_count, bool begin, Statistics statistics, const Dispatch& dispatch) {
  if (groups == 0) return 0;
  const auto turn = [&](const Variant& v, const Turn& t) {
    const gpu::ComputePipeline& p = pipeline(state, v);
    passes.device_pass(name, [&](gpu::Commands& commands) {
      commands.fill(state.header, 0, offsetof(Header, resume_count), 4);
      commands.barrier();
      dispatch(commands, p, t);
    });
  };
  // The list in parts that fit a dispatch; the last one together with the walk where there is room.
  const uint32_t chunk_turns = state.lanes * triangle_turns(state) + 2;
  const uint32_t part = std::max(turns_between_looks / 3 / chunk_turns, 1u) * state.lanes;
  const bool merge = begin && list_count <= part && chunk_turns <= turns_between_looks / 3;
  bool first = begin;
  if (begin && !merge)
    for (uint32_t from = 0; from < std::max(list_count, 1u); from += part) {
      turn({first, list_count > 0, false, false, statistics},
           {groups, from, std::min(from + part, list_count), 0, false});
      first = false;
    }
  turn({merge, merge && list_count > 0, true, false, statistics},
       {groups, 0, merge ? list_count : 0, 0, false});
  uint32_t walks = 1;
  for (uint32_t read = 1;; read ^= 1, ++walks) {
    const uint32_t left = state.read_header(passes).resume_count;
    if (left == 0) return walks;
    turn({false, false, true, true, statistics}, {left, 0, 0, read, true});
  }
}

}  // namespace penumbra::gears
