// From volumes to visibility: the view samples' depth, a stencil that counts volumes, and its reading.
#pragma once
#include <optional>

#include "techniques/stencil_shadow_volume/volumes.h"

namespace penumbra::shadow_volume {

inline constexpr VkFormat stencil_format = VK_FORMAT_D32_SFLOAT_S8_UINT;
// Whether the device can render to the format and copy its two aspects.
bool stencil_supported(gpu::Device& device);

// What each side of a volume's face does to the count where the depth test passes (or, for z-fail, fails).
struct Counting {
  VkStencilOpState front, back;
  Counting flipped() const { return {back, front}; }
};

class StencilPass {
 public:
  void setup(gpu::Device& device);
  // `near_plane`: where volumes that hold the near plane are counted first (ZP+). Passes "depth_copy",
  // "volumes", "resolve".
  void run(const RenderInput& in, const Volumes& volumes, Variant variant,
           const std::optional<Mat4d>& near_plane, gpu::PassRecorder& passes);
  const gpu::Image& image() const { return image_; }
  uint64_t bytes() const { return image_.bytes() + depth_.bytes() + stencil_.bytes(); }

 private:
  void ensure(const RenderInput& in, gpu::PassRecorder& passes);
  void draw(gpu::Commands& commands, const Volumes& volumes, Variant variant, const Camera& camera, int width,
            int height, const std::optional<Mat4d>& near_plane) const;

  gpu::GraphicsPipeline pass_, fail_, cap_front_, cap_back_, near_;
  gpu::ComputePipeline resolve_;
  gpu::Image image_;
  gpu::Buffer depth_, stencil_;
};

}  // namespace penumbra::shadow_volume
