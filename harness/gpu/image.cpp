#include <utility>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/device.h"

namespace penumbra::gpu {
namespace {

VkImageAspectFlags aspect_of(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_S8_UINT:
      return VK_IMAGE_ASPECT_STENCIL_BIT;
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
      return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

VkImageView create_view(Device& device, VkImage image, const ImageDesc& desc, VkImageViewType type,
                        uint32_t first_layer, uint32_t layers, uint32_t first_mip, uint32_t mips) {
  VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image, info.viewType = type, info.format = desc.format;
  info.subresourceRange = {aspect_of(desc.format), first_mip, mips, first_layer, layers};
  VkImageView view = VK_NULL_HANDLE;
  check(vkCreateImageView(device.handle(), &info, nullptr, &view), "image view");
  return view;
}

}  // namespace

Image::Image(Device& device, const ImageDesc& desc, const std::string& what) : device_(&device), desc_(desc) {
  VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  if (desc.cube) info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  info.imageType = VK_IMAGE_TYPE_2D, info.format = desc.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = desc.mips, info.arrayLayers = desc.layers, info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL, info.usage = desc.usage;
  check(vkCreateImage(device.handle(), &info, nullptr, &image_), what.c_str());
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(device.handle(), image_, &requirements);
  try {
    memory_ = device.allocate(requirements, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, false, nullptr, what);
  } catch (...) {
    vkDestroyImage(device.handle(), image_, nullptr);
    throw;
  }
  allocated_ = requirements.size;
  check(vkBindImageMemory(device.handle(), image_, memory_, 0), what.c_str());
  const VkImageViewType type = desc.cube                       ? VK_IMAGE_VIEW_TYPE_CUBE
                               : desc.layers > 1 || desc.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                                               : VK_IMAGE_VIEW_TYPE_2D;
  view_ = create_view(device, image_, desc, type, 0, desc.layers, 0, desc.mips);
  part_views_.resize(std::size_t{desc.layers} * desc.mips, VK_NULL_HANDLE);
}

Image::~Image() { release(); }

void Image::release() {
  if (!image_) return;
  for (VkImageView v : part_views_)
    if (v) vkDestroyImageView(device_->handle(), v, nullptr);
  vkDestroyImageView(device_->handle(), view_, nullptr);
  vkDestroyImage(device_->handle(), image_, nullptr);
  device_->free(memory_, allocated_);
}

Image::Image(Image&& o) noexcept { *this = std::move(o); }

Image& Image::operator=(Image&& o) noexcept {
  std::swap(device_, o.device_);
  std::swap(desc_, o.desc_);
  std::swap(image_, o.image_);
  std::swap(memory_, o.memory_);
  std::swap(view_, o.view_);
  std::swap(part_views_, o.part_views_);
  std::swap(allocated_, o.allocated_);
  return *this;
}

VkImageView Image::view(uint32_t layer, uint32_t mip) const {
  VkImageView& v = part_views_[std::size_t{layer} * desc_.mips + mip];
  if (!v) v = create_view(*device_, image_, desc_, VK_IMAGE_VIEW_TYPE_2D, layer, 1, mip, 1);
  return v;
}

VkImageAspectFlags Image::aspect() const { return aspect_of(desc_.format); }

}  // namespace penumbra::gpu
