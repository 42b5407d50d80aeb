// Runs a walk kernel (over the tree or the cells) to its end: first what stays outside the tree, then the
// walk, then again for the groups that used up their loop turns, until none is left.
#pragma once
#include <functional>
#include <map>
#include <vector>

#include "techniques/gears/frame_state.h"

namespace penumbra::gears {

class Walker {
 public:
  enum class Statistics : uint32_t { none, as_walked, nothing_skipped };

  // What one dispatch does, for the caller to fill its constants with.
  struct Turn {
    uint32_t work_groups = 0;
    uint32_t list_begin = 0, list_end = 0;
    uint32_t read_list = 0;
    bool resumed = false;
  };
  using Dispatch = std::function<void(gpu::Commands&, const gpu::ComputePipeline&, const Turn&)>;

  // Code for regular grids and for any samples; `more_arrays`: how many texel arrays it fetches from beside
  // the state's. Makes the kernel that every frame needs.
  void setup(const FrameState& state, gpu::Spirv grid, gpu::Spirv any, uint32_t push_bytes,
             uint32_t more_arrays);
  // Arrays that the kernel fetches from: the state's and then `more`. Again whenever they were made anew; not
  // while commands are in flight.
  void bind(const FrameState& state, std::span<const VkBufferView> more);
  // Runs passes called `name`. `begin`: masks are begun and the list done, else only the walk. Returns the
  // number of dispatches of the walk itself (1 when no group had to go on).
  uint32_t run(FrameState& state, gpu::PassRecorder& passes, const char* name, uint32_t groups,
               uint32_t list_count, bool begin, Statistics statistics, const Dispatch& dispatch);

 private:
  struct Variant {
    bool begin, list, walk, resumed;
    Statistics statistics;
    auto operator<=>(const Variant&) const = default;
  };
  void bind(const FrameState& state, gpu::ComputePipeline& pipeline) const;
  const gpu::ComputePipeline& pipeline(const FrameState& state, const Variant& v);
  uint32_t triangle_turns(const FrameState& state) const;
  uint32_t leaf_batch(const FrameState& state) const;

  gpu::Spirv grid_, any_;
  uint32_t push_bytes_ = 0;
  uint32_t arrays_ = 0;
  std::vector<VkBufferView> views_;
  std::map<Variant, gpu::ComputePipeline> pipelines_;
};

}  // namespace penumbra::gears
