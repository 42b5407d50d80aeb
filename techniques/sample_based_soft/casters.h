// What casts shadows: triangles in working space and their influence regions, per frame [Sintorn2008,
// sec. 4.1, 4.3].
#pragma once
#include "techniques/sample_based_soft/frame_state.h"

namespace penumbra::sample_based_soft {

class Casters {
 public:
  void setup(const FrameState& state);
  // Whenever texel arrays were made anew.
  void bind(const FrameState& state);
  // Topology: the order of the triangles, and which are neighbours.
  void build_topology(const FrameState& state, const Geometry& geometry, gpu::PassRecorder& passes);
  // Which triangles may be left out where they turn away from the light.
  void build_closed(const FrameState& state, const Case& c, gpu::PassRecorder& passes);
  // Pass "prepare_casters".
  void prepare(const FrameState& state, const Case& c, gpu::PassRecorder& passes);

  bool blocks() const { return blocks_; }
  // Blocks or triangles; slots of triangles, those past `block_slots` in no block.
  uint32_t count() const { return blocks_ ? block_slots_ / lanes_ : block_slots_; }
  uint32_t outline_texels() const { return outline_texels_; }  // 0: boxes alone
  const gpu::Buffer& list() const { return list_; }            // slots outside the blocks
  const TexelArray& triangles() const { return triangle_texels_; }
  const TexelArray& regions() const { return region_texels_; }
  const TexelArray& edges() const { return edge_texels_; }
  const TexelArray& outlines() const { return outline_array_; }
  uint64_t bytes() const;

 private:
  void build_neighbours(const Geometry& geometry, gpu::PassRecorder& passes);

  gpu::ComputePipeline face_, prepare_;
  gpu::Buffer order_, closed_, facing_, neighbours_, triangles_, regions_, edges_, outlines_, list_;
  TexelArray triangle_texels_, region_texels_, edge_texels_, outline_array_;
  uint32_t lanes_ = 8, triangle_count_ = 0, block_slots_ = 0, slots_ = 0, outline_texels_ = 0;
  bool blocks_ = true, silhouettes_ = false;
};

}  // namespace penumbra::sample_based_soft
