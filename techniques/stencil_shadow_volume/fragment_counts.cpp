#include "techniques/stencil_shadow_volume/fragment_counts.h"

#include <array>
#include <bit>

#include "shaders/shadow_volume_count.h"
#include "shaders/shadow_volume_volume.h"
#include "techniques/stencil_shadow_volume/stencil_pass.h"

namespace penumbra::shadow_volume {
namespace {

constexpr VkFormat count_format = VK_FORMAT_R32_SFLOAT;

// `front`, `back`: what a fragment of either side of a face adds.
gpu::GraphicsPipeline make(gpu::Device& device, float front, float back, VkCompareOp compare, bool clamp) {
  gpu::GraphicsDesc desc;
  desc.vertex = shadow_volume_volume_spv, desc.fragment = shadow_volume_count_spv;
  desc.push_bytes = sizeof(VolumePush);
  desc.constants = {{0, std::bit_cast<uint32_t>(front)}, {1, std::bit_cast<uint32_t>(back)}};
  desc.color_formats = {count_format}, desc.blend_add = true, desc.write_mask = VK_COLOR_COMPONENT_R_BIT;
  desc.depth_format = stencil_format, desc.depth_clamp = clamp;
  desc.depth_test = compare != VK_COMPARE_OP_ALWAYS, desc.depth_compare = compare;
  desc.depth_bias = true;
  return gpu::GraphicsPipeline(device, desc);
}

}  // namespace

bool FragmentCounts::supported(gpu::Device& device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical(), count_format, &properties);
  return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
}

void FragmentCounts::setup(gpu::Device& device) {
  constexpr VkCompareOp hidden = VK_COMPARE_OP_LESS_OR_EQUAL, visible = VK_COMPARE_OP_GREATER,
                        always = VK_COMPARE_OP_ALWAYS;
  behind_ = make(device, -1, 1, hidden, true);
  cap_ = make(device, -1, 1, hidden, false);
  flipped_cap_ = make(device, 1, -1, hidden, false);
  before_ = make(device, 1, -1, visible, false);
  near_ = make(device, 1, 1, always, false);
  all_clamped_ = make(device, 1, 1, always, true);
  all_ = make(device, 1, 1, always, false);
}

bool FragmentCounts::ensure(gpu::Device& device, const gpu::Image& depth) {
  gpu::ImageDesc desc;
  desc.width = depth.desc().width, desc.height = depth.desc().height, desc.format = count_format;
  desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  if (image_ && image_.desc().width == desc.width && image_.desc().height == desc.height) return false;
  image_ = gpu::Image(device, desc, "shadow volumes: fragment counts");
  return true;
}

void FragmentCounts::begin(gpu::Commands& commands, const gpu::Image& depth_image) const {
  const gpu::RenderTarget color{.view = image_.view()};
  const gpu::RenderTarget depth{.view = depth_image.view(), .load = VK_ATTACHMENT_LOAD_OP_LOAD};
  commands.begin_rendering(image_.desc().width, image_.desc().height, std::array{color}, &depth,
                           stencil_format);
}

void FragmentCounts::volumes(gpu::Commands& commands, const Volumes& volumes, const gpu::Image& depth,
                             Variant variant, const Mat4d& view,
                             const std::optional<Mat4d>& near_plane) const {
  begin(commands, depth);
  if (near_plane) volumes.draw(commands, near_, *near_plane, {LIST_NEAR_FRONT, LIST_NEAR_BACK}, 0);
  if (variant == Variant::z_fail) {
    volumes.draw(commands, behind_, view, {LIST_SIDES, LIST_FAR}, side_slope_bias);
    volumes.draw(commands, cap_, view, {LIST_NEAR_FRONT}, 0);
    volumes.draw(commands, flipped_cap_, view, {LIST_NEAR_BACK}, 0);
  } else {
    volumes.draw(commands, before_, view, {LIST_SIDES}, side_slope_bias);
  }
  commands.end_rendering();
}

void FragmentCounts::fill(gpu::Commands& commands, const Volumes& volumes, const gpu::Image& depth,
                          Variant variant, const Mat4d& view, const std::optional<Mat4d>& near_plane) const {
  const bool clamp = variant == Variant::z_fail;
  const gpu::GraphicsPipeline& all = clamp ? all_clamped_ : all_;
  begin(commands, depth);
  volumes.draw(commands, all, view, {LIST_SIDES}, 0);
  if (clamp) volumes.draw(commands, all, view, {LIST_NEAR_FRONT, LIST_NEAR_BACK, LIST_FAR}, 0);
  if (near_plane) volumes.draw(commands, all, *near_plane, {LIST_NEAR_FRONT, LIST_NEAR_BACK}, 0);
  commands.end_rendering();
}

}  // namespace penumbra::shadow_volume
