// An array of vec4 (or, with another format of 16 bytes, uvec4) that shaders read by texelFetch: a
// two-dimensional image of RGBA32F with rows of texel_row entries. On lavapipe a fetch gathers eight lanes at
// once, where a load by buffer address is a loop over lanes and components, five times slower.
#pragma once
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/pass_recorder.h"

namespace penumbra {

inline constexpr uint32_t texel_row = 8192;  // as in shaders/texels.glsl

class TexelArray {
 public:
  // Room for `count` entries; what was there is lost when it grows. True when the view changed. Throws
  // PointError when the device has no image so large.
  bool ensure(gpu::Device& device, gpu::PassRecorder& passes, std::size_t count, const std::string& what,
              VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT);
  // Entries [0, count) from a buffer of vec4.
  void copy_from(gpu::Commands& commands, const gpu::Buffer& buffer, std::size_t count) const;
  VkImageView view() const { return image_.view(); }
  uint64_t bytes() const { return image_ ? image_.bytes() : 0; }

 private:
  gpu::Image image_;
};

}  // namespace penumbra
