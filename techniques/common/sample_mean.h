// Hard shadows of one light sample after the other, averaged: visibility and mask of an area light.
#pragma once
#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"

namespace penumbra {

class SampleMean {
 public:
  void setup(const Case& c);
  // Where a hard shadow of one light sample goes: visibility per pixel.
  const gpu::Buffer& lit() const { return lit_; }
  // Adds lit() as light sample `i` to the output of `in`; samples come in order. Pass "accumulate".
  void add(const RenderInput& in, int i, gpu::PassRecorder& passes) const;
  uint64_t bytes() const { return lit_.bytes(); }

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Buffer lit_;
};

}  // namespace penumbra
