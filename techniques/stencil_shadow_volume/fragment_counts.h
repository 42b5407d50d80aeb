// Counts in floats: exact up to 2^24, where a stencil wraps at 256. For pictures whose volumes may lie more
// than 255 deep, and for the statistics.
#pragma once
#include <optional>

#include "techniques/stencil_shadow_volume/volumes.h"

namespace penumbra::shadow_volume {

class FragmentCounts {
 public:
  // Whether the device can add up floats in a picture.
  static bool supported(gpu::Device& device);
  void setup(gpu::Device& device);
  // As large as `depth`; true when it was made anew and has to be initialised.
  bool ensure(gpu::Device& device, const gpu::Image& depth);
  const gpu::Image& image() const { return image_; }
  // What the stencil holds modulo 256, against the depth that the view samples left.
  void volumes(gpu::Commands& commands, const Volumes& volumes, const gpu::Image& depth, Variant variant,
               const Mat4d& view, const std::optional<Mat4d>& near_plane) const;
  // Every fragment that is made, whatever the depth test says.
  void fill(gpu::Commands& commands, const Volumes& volumes, const gpu::Image& depth, Variant variant,
            const Mat4d& view, const std::optional<Mat4d>& near_plane) const;
  uint64_t bytes() const { return image_.bytes(); }

 private:
  void begin(gpu::Commands& commands, const gpu::Image& depth) const;

  gpu::GraphicsPipeline behind_, cap_, flipped_cap_, before_, near_, all_clamped_, all_;
  gpu::Image image_;
};

}  // namespace penumbra::shadow_volume
