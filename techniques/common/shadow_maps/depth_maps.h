// The depth maps themselves: one square layer per map, cascade or face, drawn from the light.
#pragma once
#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/common/shadow_maps/fitter.h"

namespace penumbra::shadow_map {

VkFormat vulkan_format(DepthFormat format);
// Whether the device can render to the format and read it in shaders.
bool supported(gpu::Device& device, DepthFormat format);

class DepthMaps {
 public:
  explicit DepthMaps(const Params& params) : params_(params) {}
  void setup(gpu::Device& device);
  // Allocates on the first call and when more layers are needed than ever before. Pass "depth_map".
  void draw(const Case& c, const Fitted& fitted, gpu::PassRecorder& passes);

  const gpu::Image& image() const { return image_; }
  const gpu::Buffer& layers() const { return layers_; }  // MapLayer per layer
  uint64_t bytes() const { return image_.bytes() + layers_.bytes(); }

 private:
  void draw_layer(gpu::Commands& commands, const Case& c, const FittedLayer& layer);
  void ensure_image(gpu::Device& device, uint32_t layers, gpu::PassRecorder& passes);

  Params params_;
  gpu::GraphicsPipeline pipeline_, log_pipeline_;
  gpu::Image image_;
  gpu::Buffer layers_;
};

}  // namespace penumbra::shadow_map
