// View samples for texelFetch: P' (w = 0: no view sample), P and Ng per pixel; see TexelArray for why.
#pragma once
#include "samples/view_samples.h"
#include "techniques/common/texel_array.h"

namespace penumbra {

struct ViewTexels {
  TexelArray origin, position, normal;

  void ensure(gpu::Device& device, gpu::PassRecorder& passes, std::size_t pixels);
  void copy_from(gpu::Commands& commands, const ViewSamples& samples, std::size_t pixels) const;
  uint64_t bytes() const { return origin.bytes() + position.bytes() + normal.bytes(); }
};

}  // namespace penumbra
