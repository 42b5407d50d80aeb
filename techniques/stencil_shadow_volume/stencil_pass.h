// From volumes to visibility: the view samples' depth, a stencil that counts volumes, and its reading.
#pragma once
#include <optional>

#include "techniques/stencil_shadow_volume/fragment_counts.h"
#include "techniques/stencil_shadow_volume/volumes.h"

namespace penumbra::shadow_volume {

inline constexpr VkFormat stencil_format = VK_FORMAT_D32_SFLOAT_S8_UINT;
// Whether the device can render to the format and copy its two aspects.
bool stencil_supported(gpu::Device& device);

// Sides are pushed back by what their depth changes over 1/512 of a pixel: so far may a rasteriser that snaps
// vertices to 1/256 of a pixel draw a triangle past its rim. There a side that hangs on that rim is found
// before the surface that it hangs on, though it is behind it.
inline constexpr float side_slope_bias = -1.0f / 512;

// What each side of a volume's face does to the count where the depth test passes (or, for z-fail, fails).
struct Counting {
  VkStencilOpState front, back;
  Counting flipped() const { return {back, front}; }
};

class StencilPass {
 public:
  void setup(gpu::Device& device);
  // `near_plane`: where volumes that hold the near plane are counted first (ZP+). `wide`: counts in floats.
  // Visibility goes to `to`. Passes "depth_copy", "volumes", "resolve".
  void run(const RenderInput& in, const Volumes& volumes, Variant variant,
           const std::optional<Mat4d>& near_plane, bool wide, const gpu::Buffer& to,
           gpu::PassRecorder& passes);
  const gpu::Image& image() const { return image_; }
  uint64_t bytes() const { return image_.bytes() + wide_.bytes() + depth_.bytes() + counts_.bytes(); }

 private:
  void ensure(const RenderInput& in, bool wide, gpu::PassRecorder& passes);
  void draw(gpu::Commands& commands, const Volumes& volumes, Variant variant, const Mat4d& view,
            const std::optional<Mat4d>& near_plane) const;
  void resolve(const RenderInput& in, const LightEmission& light, bool wide, const gpu::Buffer& to,
               gpu::PassRecorder& passes) const;

  gpu::GraphicsPipeline pass_, fail_, cap_front_, cap_back_, near_;
  gpu::ComputePipeline resolve_, resolve_wide_;
  gpu::Image image_;
  FragmentCounts wide_;
  gpu::Buffer depth_, counts_;
};

}  // namespace penumbra::shadow_volume
