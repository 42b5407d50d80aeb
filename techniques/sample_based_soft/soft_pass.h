// Groups of view samples through the casters of their lists: the masks [Sintorn2008, sec. 4.2].
#pragma once
#include <map>

#include "techniques/sample_based_soft/coverage.h"
#include "techniques/sample_based_soft/plane_table.h"

namespace penumbra::sample_based_soft {

// Words of a mask that a pass keeps in registers.
int words_per_pass(const MaskLayout& layout);

class SoftPass {
 public:
  enum class Statistics : uint32_t { none, as_walked, nothing_skipped };

  void setup(const FrameState& state, const Casters& casters);
  // Whenever texel arrays were made anew; not while commands are in flight.
  void bind(const FrameState& state, const Casters& casters, const PlaneTable& table);
  // Passes "split_groups", "soft_shadows", "hard_shadows" for the groups of one chunk.
  void run(FrameState& state, const RenderInput& in, const Casters& casters, const SampleLists& lists,
           const Coverage& coverage, const Chunk& chunk, Statistics statistics, gpu::PassRecorder& passes);

  uint32_t dispatches() const { return dispatches_; }  // of the walks since the last reset
  uint32_t hard_groups() const { return hard_groups_; }
  void reset() { dispatches_ = hard_groups_ = 0; }
  uint64_t bytes() const { return work_.bytes() + resume_.bytes(); }

 private:
  struct Variant {
    bool begin, list, walk, resumed, hard;
    Statistics statistics;
    auto operator<=>(const Variant&) const = default;
  };
  struct Part {
    uint32_t groups = 0, first = 0;
    bool hard = false;
  };
  const gpu::ComputePipeline& pipeline(const FrameState& state, const Variant& v);
  void walk(FrameState& state, WalkConstants pc, const Part& part, uint32_t listed, Statistics statistics,
            gpu::PassRecorder& passes);

  gpu::ComputePipeline split_;
  std::map<Variant, gpu::ComputePipeline> pipelines_;
  std::vector<VkImageView> views_;
  gpu::Buffer work_, resume_;
  bool blocks_ = true;
  uint32_t dispatches_ = 0, hard_groups_ = 0;
};

}  // namespace penumbra::sample_based_soft
