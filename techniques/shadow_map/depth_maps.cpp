#include "techniques/shadow_map/depth_maps.h"

#include <array>

#include "shaders/shadow_map_depth.h"

namespace penumbra::shadow_map {
namespace {

VkCullModeFlags cull(CasterFaces faces) {
  switch (faces) {
    case CasterFaces::both:
      return VK_CULL_MODE_NONE;
    case CasterFaces::front:
      return VK_CULL_MODE_BACK_BIT;
    case CasterFaces::back:
      return VK_CULL_MODE_FRONT_BIT;
  }
  return VK_CULL_MODE_NONE;
}

}  // namespace

VkFormat vulkan_format(DepthFormat format) {
  switch (format) {
    case DepthFormat::d16:
      return VK_FORMAT_D16_UNORM;
    case DepthFormat::d24:
      return VK_FORMAT_X8_D24_UNORM_PACK32;
    case DepthFormat::d32:
      return VK_FORMAT_D32_SFLOAT;
  }
  return VK_FORMAT_D32_SFLOAT;
}

bool supported(gpu::Device& device, DepthFormat format) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical(), vulkan_format(format), &properties);
  constexpr VkFormatFeatureFlags needed =
      VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
  return (properties.optimalTilingFeatures & needed) == needed;
}

void DepthMaps::setup(gpu::Device& device) {
  gpu::GraphicsDesc desc;
  desc.vertex = shadow_map_depth_spv;
  desc.push_bytes = sizeof(DepthPush);
  desc.vertex_strides = {3 * sizeof(float)};
  desc.depth_format = vulkan_format(params_.depth_format);
  desc.cull = cull(params_.caster_faces);
  desc.depth_test = desc.depth_write = true;
  desc.depth_compare = VK_COMPARE_OP_LESS;
  desc.depth_clamp = true;  // casters before the near plane still cast
  desc.depth_bias = true;
  pipeline_ = gpu::GraphicsPipeline(device, desc);
  layers_ = gpu::Buffer(device, max_layers * sizeof(MapLayer), gpu::Memory::upload, "shadow map layers");
}

void DepthMaps::ensure_image(gpu::Device& device, uint32_t layers, gpu::PassRecorder& passes) {
  if (image_ && image_.desc().layers >= layers) return;
  const auto size = static_cast<uint32_t>(params_.map_size);
  image_ = gpu::Image();  // free first: both at once might not fit
  gpu::ImageDesc desc;
  desc.width = desc.height = size, desc.layers = layers, desc.array = true;
  desc.format = vulkan_format(params_.depth_format);
  desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
               VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  image_ = gpu::Image(device, desc, "shadow map");
  passes.device_pass("depth_map", [&](gpu::Commands& commands) { commands.initialise(image_); });
}

void DepthMaps::draw(const Case& c, const Fitted& fitted, gpu::PassRecorder& passes) {
  ensure_image(*c.device, static_cast<uint32_t>(fitted.layers.size()), passes);
  passes.host_pass("fit", [&] {
    for (std::size_t i = 0; i < fitted.layers.size(); ++i) {
      const FittedLayer& l = fitted.layers[i];
      layers_.view<MapLayer>()[i] =
          make_layer(l.clip_from_world, fitted.light, l.frame, l.view_lo, l.view_hi);
    }
  });
  const auto size = static_cast<uint32_t>(params_.map_size);
  const std::array buffers{c.geometry->positions.handle()};
  passes.device_pass("depth_map", [&](gpu::Commands& commands) {
    for (uint32_t i = 0; i < fitted.layers.size(); ++i) {
      if (!fitted.layers[i].used) continue;
      gpu::RenderTarget target;
      target.view = image_.view(i);
      target.clear.depthStencil = {1, 0};
      commands.begin_rendering(size, size, {}, &target, vulkan_format(params_.depth_format));
      commands.bind(pipeline_);
      const DepthPush push{to_float(fitted.layers[i].clip_from_world)};
      commands.push(pipeline_, &push, sizeof push);
      commands.set_depth_bias(0, params_.slope_bias);
      commands.vertex_buffers(buffers);
      commands.draw_indexed(c.geometry->indices, 3 * c.geometry->triangle_count);
      commands.end_rendering();
    }
  });
}

}  // namespace penumbra::shadow_map
