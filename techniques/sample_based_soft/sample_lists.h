// The lists of view samples in the light's view: one dense array, cut into groups [Sintorn2008, sec. 3.1].
#pragma once
#include "techniques/common/prefix_scan.h"
#include "techniques/common/sample_groups.h"
#include "techniques/sample_based_soft/frame_state.h"

namespace penumbra::sample_based_soft {

class SampleLists {
 public:
  void setup(const FrameState& state);
  // Whenever texel arrays were made anew.
  void bind(const FrameState& state);
  // Passes "project_samples", "bin_samples", "group_samples". Waits for the device.
  void run(const FrameState& state, const RenderInput& in, gpu::PassRecorder& passes);
  uint32_t group_count() const;
  uint32_t group_capacity(const FrameState& state) const;

  const gpu::Buffer& farthest() const { return farthest_; }  // per list, then per tile
  const gpu::Buffer& lengths() const { return lengths_; }
  const gpu::Buffer& first_groups() const { return first_groups_; }
  const gpu::Buffer& slots() const { return slots_; }
  const gpu::Buffer& group_lists() const { return group_lists_; }
  uint64_t bytes() const;

 private:
  void allocate(const FrameState& state);

  gpu::ComputePipeline project_, bin_[2], measure_[2];
  PrefixScan bin_scan_, group_scan_;
  SampleGroups groups_;
  gpu::Buffer places_, bins_, counts_, begins_, farthest_, lengths_, first_groups_, slots_, group_lists_;
  gpu::Buffer bin_scratch_, group_scratch_, scratch_host_;
  uint32_t slices_ = 1;
};

}  // namespace penumbra::sample_based_soft
