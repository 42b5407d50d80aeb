// The lookup table of light samples behind planes [Sintorn2008, sec. 4.2]; see shaders/build_table.comp.
#pragma once
#include "techniques/sample_based_soft/frame_state.h"

namespace penumbra::sample_based_soft {

class PlaneTable {
 public:
  // Pass "build_table". Without half_spaces=table one texel that nothing reads.
  void build(const FrameState& state, gpu::PassRecorder& passes);
  VkImageView view() const { return texels_.view(); }
  uint64_t bytes() const { return texels_.bytes(); }

 private:
  TexelArray texels_;
};

// Texels of an entry: its words, four to a texel.
uint32_t entry_texels(const MaskLayout& layout);

}  // namespace penumbra::sample_based_soft
