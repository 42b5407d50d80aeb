// assignment: triangles. The paper's grid: view samples and triangles assigned to cells by projecting them
// with the grid camera C, everything anew every frame [GEARS, A.1 to A.3].
#pragma once
#include "technique/illustration.h"
#include "techniques/common/prefix_scan.h"
#include "techniques/gears/frame_state.h"
#include "techniques/gears/walker.h"

namespace penumbra::gears {

class Cells {
 public:
  void setup(FrameState& state);
  void build(FrameState& state, const Geometry& geometry, gpu::PassRecorder& passes);
  void render(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes);
  void count(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes, Counters& counters);
  // Of the last frame: how its view samples and triangles lie on the grid, and what each view sample tests.
  std::vector<Illustration> illustrations(FrameState& state, const RenderInput& in,
                                          gpu::PassRecorder& passes) const;
  uint64_t bytes() const;

 private:
  // Cells [begin, end) whose lists are made and used together.
  struct Chunk {
    uint32_t begin = 0, end = 0;
    uint32_t first_offset = 0;  // modulo 2^32
    uint32_t first_group = 0, groups = 0;
  };
  void bind(const FrameState& state);  // the arrays that the kernels fetch from
  uint32_t cell_count() const;         // with the one for what has no place on the grid
  void allocate(FrameState& state);
  void bin_samples(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes);
  void count_triangles(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes);
  void plan_chunks(FrameState& state, gpu::PassRecorder& passes);
  void walk_chunks(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes,
                   Walker::Statistics statistics);
  void bin_triangles(const FrameState& state, gpu::Commands& commands, uint32_t stage, uint32_t large,
                     const Chunk& chunk) const;
  uint64_t budget(const FrameState& state) const;

  Walker walker_;
  PrefixScan sample_scan_, triangle_scan_;
  gpu::ComputePipeline prepare_, fit_[2], bin_samples_[2], bin_small_[2], bin_large_[2];
  // Per cell: view samples, first group; triangles, offset, triangles put so far.
  gpu::Buffer histogram_, sample_counts_, first_groups_, triangle_counts_, offsets_, placed_;
  gpu::Buffer sample_scratch_, triangle_scratch_, scratch_host_, counts_host_;
  gpu::Buffer group_cells_, large_, assigned_;
  std::vector<Chunk> chunks_;
  bool bound_ = false;
  uint32_t grid_size_ = 0, group_count_ = 0, list_count_ = 0, large_count_ = 0, walks_ = 0;
  uint64_t assignments_ = 0;  // of triangles to cells
};

}  // namespace penumbra::gears
