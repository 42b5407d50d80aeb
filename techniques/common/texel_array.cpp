#include "techniques/common/texel_array.h"

#include <fmt/format.h>

#include "core/error.h"
#include "gpu/device.h"

namespace penumbra {

bool TexelArray::ensure(gpu::Device& device, gpu::PassRecorder& passes, std::size_t count,
                        const std::string& what, VkFormat format) {
  const std::size_t rows = count / texel_row + 1;
  if (image_ && image_.desc().height >= rows) return false;
  if (rows > device.caps().max_image_2d || texel_row > device.caps().max_image_2d)
    throw PointError(fmt::format("{} takes an image of {} x {}; this device has at most {} a side.", what,
                                 texel_row, rows, device.caps().max_image_2d));
  image_ = {};
  gpu::ImageDesc desc;
  desc.width = texel_row;
  desc.height = static_cast<uint32_t>(rows);
  desc.format = format;
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  image_ = gpu::Image(device, desc, what);
  passes.device_pass("initialise_images", [&](gpu::Commands& commands) { commands.initialise(image_); });
  return true;
}

void TexelArray::copy_from(gpu::Commands& commands, const gpu::Buffer& buffer, std::size_t count) const {
  const uint32_t rows = static_cast<uint32_t>(count / texel_row),
                 rest = static_cast<uint32_t>(count % texel_row);
  VkBufferImageCopy regions[2]{};
  uint32_t used = 0;
  const auto region = [&](uint32_t first, uint32_t width, uint32_t height) {
    VkBufferImageCopy& r = regions[used++];
    r.bufferOffset = uint64_t{first} * texel_row * 16;
    r.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    r.imageOffset = {0, static_cast<int32_t>(first), 0};
    r.imageExtent = {width, height, 1};
  };
  if (rows > 0) region(0, texel_row, rows);
  if (rest > 0) region(rows, rest, 1);
  if (used > 0)
    vkCmdCopyBufferToImage(commands.handle(), buffer.handle(), image_.handle(), VK_IMAGE_LAYOUT_GENERAL, used,
                           regions);
}

}  // namespace penumbra
