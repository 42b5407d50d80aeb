#include "techniques/common/shadow_maps/depth_maps.h"

#include <array>

#include "shaders/shadow_map_depth.h"
#include "shaders/shadow_map_log_depth_frag.h"
#include "shaders/shadow_map_log_depth_vert.h"

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
  if (params_.warp == Warp::log) {
    desc.vertex = shadow_map_log_depth_vert_spv, desc.fragment = shadow_map_log_depth_frag_spv;
    desc.push_bytes = sizeof(LogDepthPush);
    desc.vertex_strides.clear();
    desc.cull = VK_CULL_MODE_NONE;  // of the triangles' rectangles; the shader culls triangles
    desc.depth_bias = false;        // the shader's too
    desc.constants = {{0, static_cast<uint32_t>(params_.caster_faces)}};
    log_pipeline_ = gpu::GraphicsPipeline(device, desc);
  }
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

void DepthMaps::draw_layer(gpu::Commands& commands, const Case& c, const FittedLayer& layer) {
  const GeometryOnDevice& geometry = *c.geometry;
  if (layer.log.scale != 0) {
    const LogDepthPush push{to_float(layer.clip_from_world),      geometry.positions.address(),
                            geometry.indices.address(),           static_cast<float>(layer.log.scale),
                            static_cast<float>(layer.log.offset), params_.slope_bias,
                            static_cast<float>(params_.map_size)};
    commands.bind(log_pipeline_);
    commands.push(log_pipeline_, &push, sizeof push);
    commands.draw(6 * geometry.triangle_count);
    return;
  }
  const std::array buffers{geometry.positions.handle()};
  const DepthPush push{to_float(layer.clip_from_world)};
  commands.bind(pipeline_);
  commands.push(pipeline_, &push, sizeof push);
  commands.set_depth_bias(0, params_.slope_bias);
  commands.vertex_buffers(buffers);
  commands.draw_indexed(geometry.indices, 3 * geometry.triangle_count);
}

void DepthMaps::draw(const Case& c, const Fitted& fitted, gpu::PassRecorder& passes) {
  ensure_image(*c.device, static_cast<uint32_t>(fitted.layers.size()), passes);
  passes.host_pass("fit", [&] {
    const Light& light = c.frame->light;
    for (std::size_t i = 0; i < fitted.layers.size(); ++i) {
      const FittedLayer& l = fitted.layers[i];
      const bool sphere = light.kind == LightKind::sphere;
      const Vec3d u = sphere ? l.frame.right * (2.0 * double(light.radius)) : Vec3d(light.edge_u);
      const Vec3d v = sphere ? l.frame.down * (2.0 * double(light.radius)) : Vec3d(light.edge_v);
      layers_.view<MapLayer>()[i] = make_layer(l, fitted.light, params_.map_size, u, v);
    }
  });
  const auto size = static_cast<uint32_t>(params_.map_size);
  passes.device_pass("depth_map", [&](gpu::Commands& commands) {
    for (uint32_t i = 0; i < fitted.layers.size(); ++i) {
      if (!fitted.layers[i].used) continue;
      gpu::RenderTarget target;
      target.view = image_.view(i);
      target.clear.depthStencil = {1, 0};
      commands.begin_rendering(size, size, {}, &target, vulkan_format(params_.depth_format));
      draw_layer(commands, c, fitted.layers[i]);
      commands.end_rendering();
    }
  });
}

}  // namespace penumbra::shadow_map
