// Masks as walked to masks and visibility as handed out; see shaders/mask_resolve.comp.
#pragma once
#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "techniques/common/mask_layout.h"

namespace penumbra {

class MaskResolve {
 public:
  void setup(gpu::Device& device, const MaskLayout& layout);
  // `walked` and `masks` are addresses: the same where the layout is packed. `weights`: 0 where all weigh the
  // same.
  void run(uint64_t walked, uint64_t masks, uint64_t visibility, uint64_t weights, uint32_t pixels,
           gpu::PassRecorder& passes, uint64_t places = 0) const;

 private:
  gpu::ComputePipeline pipeline_;
  uint32_t mask_words_ = 0;
};

}  // namespace penumbra
