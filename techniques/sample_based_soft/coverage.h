// Which casters each list of view samples has: those whose influence regions touch it. Tiles of lists first,
// then the lists of each tile; counted before they are written, so that nothing can overflow.
#pragma once
#include "techniques/common/prefix_scan.h"
#include "techniques/sample_based_soft/casters.h"
#include "techniques/sample_based_soft/sample_lists.h"

namespace penumbra::sample_based_soft {

// Lists whose casters are held at one time, and their groups.
struct Chunk {
  uint32_t begin = 0, end = 0;
  uint32_t first_caster = 0;  // of all lists' casters in one array, modulo 2^32
  uint32_t first_group = 0, groups = 0;
};

class Coverage {
 public:
  void setup(const FrameState& state, const Casters& casters);
  // Whenever texel arrays were made anew.
  void bind(const FrameState& state, const Casters& casters);
  // Passes "cover_tiles", "cover_lists": counts, and plans the chunks.
  void count(FrameState& state, const Casters& casters, const SampleLists& lists, uint32_t group_count,
             gpu::PassRecorder& passes);
  const std::vector<Chunk>& chunks() const { return chunks_; }
  // Pass "cover_lists": writes the lists of one chunk.
  void write(const FrameState& state, const Casters& casters, const SampleLists& lists, const Chunk& chunk,
             gpu::PassRecorder& passes);

  const gpu::Buffer& counts() const { return counts_; }  // per list
  const gpu::Buffer& begins() const { return begins_; }
  const gpu::Buffer& casters() const { return casters_; }
  const gpu::Buffer& penumbrae() const { return penumbrae_; }
  uint32_t listed() const { return listed_; }  // triangles outside the blocks
  uint64_t total() const { return total_; }    // pairs of list and caster
  uint64_t bytes() const;

 private:
  uint64_t budget(const FrameState& state, const Casters& casters) const;
  void dispatch(gpu::Commands& commands, const FrameState& state, const Casters& casters,
                const SampleLists& lists, bool tiles, uint32_t stage, const Chunk& chunk) const;
  void plan(const FrameState& state, const Casters& casters, const SampleLists& lists, uint32_t group_count,
            gpu::PassRecorder& passes);

  gpu::ComputePipeline cover_[2][2];  // [tiles][stage]
  PrefixScan scan_;
  gpu::Buffer tile_counts_, tile_begins_, tile_casters_, counts_, begins_, casters_, penumbrae_;
  gpu::Buffer tile_scratch_, scratch_, scratch_host_, plan_host_;
  std::vector<Chunk> chunks_;
  uint64_t total_ = 0;
  uint32_t listed_ = 0;
};

}  // namespace penumbra::sample_based_soft
