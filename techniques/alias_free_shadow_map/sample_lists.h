// The lists of view samples: one dense array, and offset and length per texel [Sintorn2008, sec. 3.1].
#pragma once
#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/alias_free_shadow_map/fitter.h"
#include "techniques/common/prefix_scan.h"
#include "techniques/common/texel_array.h"

namespace penumbra::alias_free {

class SampleLists {
 public:
  explicit SampleLists(const Params& params) : params_(params) {}
  void setup(const Case& c);
  // Passes "count", "scan", "fill". All of blocked() is 0 afterwards. `progress`: CasterPass's, emptied, and
  // told of view samples on the inside of closed meshes, which `away` (Casters) tells.
  void run(uint32_t pixels, const LightView& view, const Fitter& fitter, const gpu::Buffer& away,
           const gpu::Buffer& progress, gpu::PassRecorder& passes);

  const gpu::Buffer& lengths() const { return lengths_; }         // per texel, and one 0
  const gpu::Buffer& offsets() const { return offsets_; }         // per texel, and the end of the last
  const gpu::Buffer& slots() const { return slots_; }             // per pixel: place in the array, no_slot
  const TexelArray& list_texels() const { return list_texels_; }  // as Fitter::samples()
  const gpu::Buffer& blocked() const { return blocked_; }         // 1 per place in shadow, else 0
  uint32_t texels() const { return texels_; }
  uint64_t bytes() const;
  // Offsets, lengths and the arrays of the lists themselves.
  uint64_t list_bytes() const;

 private:
  void allocate(gpu::PassRecorder& passes, uint32_t pixels);

  Params params_;
  gpu::ComputePipeline count_[2], fill_;  // [six faces]
  PrefixScan scan_;
  gpu::Buffer lengths_, offsets_, scratch_, pixel_texels_, slots_, lists_, blocked_;
  TexelArray list_texels_;  // lists_ again, for fetching
  uint32_t texels_ = 0;
};

}  // namespace penumbra::alias_free
