// The slides' tables: angles, and the light's area between two of them.
#pragma once
#include "gpu/pass_recorder.h"

namespace penumbra::soft_shadow_volume {

class Tables {
 public:
  // `size`: intervals per axis; 0 makes the smallest images that a shader can be given and not read.
  void make(gpu::Device& device, gpu::PassRecorder& passes, uint32_t shape, int size);
  VkImageView angles() const { return angles_.view(); }
  VkImageView areas() const { return areas_.view(); }
  uint64_t bytes() const { return angles_.bytes() + areas_.bytes(); }

 private:
  gpu::Image angles_, areas_;
};

}  // namespace penumbra::soft_shadow_volume
