#include "gpu/commands.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "gpu/device.h"

namespace penumbra::gpu {

void Commands::bind(const Pipeline& pipeline) {
  vkCmdBindPipeline(handle_, pipeline.bind_point(), pipeline.handle());
  if (const VkDescriptorSet set = pipeline.descriptors())
    vkCmdBindDescriptorSets(handle_, pipeline.bind_point(), pipeline.layout(), 0, 1, &set, 0, nullptr);
}

void Commands::push(const Pipeline& pipeline, const void* data, std::size_t bytes) {
  assert(bytes <= 128 && bytes == pipeline.push_bytes());
  vkCmdPushConstants(handle_, pipeline.layout(), pipeline.push_stages(), 0, static_cast<uint32_t>(bytes),
                     data);
}

void Commands::dispatch_groups(uint64_t groups) {
  if (groups == 0) return;
  constexpr uint64_t row = 65535;  // the limit that every device guarantees
  const auto rows = static_cast<uint32_t>((groups + row - 1) / row);
  vkCmdDispatch(handle_, static_cast<uint32_t>(std::min(groups, row)), rows, 1);
}

void Commands::dispatch_indirect_groups(const Buffer& counts, uint64_t offset) {
  vkCmdDispatchIndirect(handle_, counts.handle(), offset);
}

void Commands::begin_rendering(uint32_t width, uint32_t height, std::span<const RenderTarget> colors,
                               const RenderTarget* depth, VkFormat depth_format, uint32_t layers) {
  const auto attachment = [](const RenderTarget& t) {
    VkRenderingAttachmentInfo a{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    a.imageView = t.view, a.imageLayout = VK_IMAGE_LAYOUT_GENERAL, a.loadOp = t.load;
    a.storeOp = VK_ATTACHMENT_STORE_OP_STORE, a.clearValue = t.clear;
    return a;
  };
  std::vector<VkRenderingAttachmentInfo> color_infos;
  for (const RenderTarget& c : colors) color_infos.push_back(attachment(c));
  VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea.extent = {width, height};
  info.layerCount = layers;
  info.colorAttachmentCount = static_cast<uint32_t>(color_infos.size()),
  info.pColorAttachments = color_infos.data();
  VkRenderingAttachmentInfo depth_info{};
  if (depth) {
    depth_info = attachment(*depth);
    const bool stencil_only = depth_format == VK_FORMAT_S8_UINT;
    const bool with_stencil = depth_format == VK_FORMAT_D32_SFLOAT_S8_UINT ||
                              depth_format == VK_FORMAT_D24_UNORM_S8_UINT ||
                              depth_format == VK_FORMAT_D16_UNORM_S8_UINT;
    if (!stencil_only) info.pDepthAttachment = &depth_info;
    if (stencil_only || with_stencil) info.pStencilAttachment = &depth_info;
  }
  vkCmdBeginRendering(handle_, &info);
  set_viewport(0, 0, static_cast<float>(width), static_cast<float>(height));
  set_scissor(0, 0, width, height);
}

void Commands::end_rendering() { vkCmdEndRendering(handle_); }

void Commands::set_viewport(float x, float y, float width, float height) {
  const VkViewport v{x, y, width, height, 0, 1};
  vkCmdSetViewport(handle_, 0, 1, &v);
}

void Commands::set_scissor(int x, int y, uint32_t width, uint32_t height) {
  const VkRect2D r{{x, y}, {width, height}};
  vkCmdSetScissor(handle_, 0, 1, &r);
}

void Commands::set_depth_bias(float constant, float slope, float clamp) {
  vkCmdSetDepthBias(handle_, constant, clamp, slope);
}

void Commands::vertex_buffers(std::span<const VkBuffer> buffers) {
  const std::vector<VkDeviceSize> offsets(buffers.size(), 0);
  vkCmdBindVertexBuffers(handle_, 0, static_cast<uint32_t>(buffers.size()), buffers.data(), offsets.data());
}

void Commands::draw_indexed(const Buffer& indices, uint32_t index_count, uint32_t instances,
                            uint32_t first_index) {
  vkCmdBindIndexBuffer(handle_, indices.handle(), 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(handle_, index_count, instances, first_index, 0, 0);
}

void Commands::draw_indexed_indirect(const Buffer& indices, const Buffer& arguments, uint64_t offset) {
  vkCmdBindIndexBuffer(handle_, indices.handle(), 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexedIndirect(handle_, arguments.handle(), offset, 1, sizeof(VkDrawIndexedIndirectCommand));
}

void Commands::clear_stencil(uint32_t value, uint32_t width, uint32_t height) {
  VkClearAttachment clear{};
  clear.aspectMask = VK_IMAGE_ASPECT_STENCIL_BIT, clear.clearValue.depthStencil.stencil = value;
  const VkClearRect all{{{0, 0}, {width, height}}, 0, 1};
  vkCmdClearAttachments(handle_, 1, &clear, 1, &all);
}

void Commands::draw(uint32_t vertices, uint32_t instances, uint32_t first_vertex) {
  vkCmdDraw(handle_, vertices, instances, first_vertex, 0);
}

void Commands::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset,
                    uint64_t to_offset) {
  if (bytes == 0) return;
  const VkBufferCopy region{from_offset, to_offset, bytes};
  vkCmdCopyBuffer(handle_, from.handle(), to.handle(), 1, &region);
}

void Commands::fill(const Buffer& buffer, uint32_t value, uint64_t offset, uint64_t bytes) {
  vkCmdFillBuffer(handle_, buffer.handle(), offset, bytes, value);
}

void Commands::update(const Buffer& buffer, const void* data, uint64_t bytes, uint64_t offset) {
  vkCmdUpdateBuffer(handle_, buffer.handle(), offset, bytes, data);
}

void Commands::copy_image_to_buffer(const Image& image, const Buffer& buffer, VkImageAspectFlags aspect,
                                    uint32_t layer, uint64_t offset) {
  VkBufferImageCopy region{};
  region.bufferOffset = offset;
  region.imageSubresource = {aspect, 0, layer, 1};
  region.imageExtent = {image.desc().width, image.desc().height, 1};
  vkCmdCopyImageToBuffer(handle_, image.handle(), VK_IMAGE_LAYOUT_GENERAL, buffer.handle(), 1, &region);
}

void Commands::copy_buffer_to_image(const Buffer& buffer, const Image& image, VkImageAspectFlags aspect,
                                    uint64_t offset) {
  VkBufferImageCopy region{};
  region.bufferOffset = offset;
  region.imageSubresource = {aspect, 0, 0, 1};
  region.imageExtent = {image.desc().width, image.desc().height, 1};
  vkCmdCopyBufferToImage(handle_, buffer.handle(), image.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &region);
}

void Commands::initialise(const Image& image) {
  VkImageMemoryBarrier2 b{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  b.srcStageMask = b.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  b.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED, b.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  b.image = image.handle();
  b.subresourceRange = {image.aspect(), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1, info.pImageMemoryBarriers = &b;
  vkCmdPipelineBarrier2(handle_, &info);
}

void Commands::barrier() {
  VkMemoryBarrier2 b{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  b.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  b.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
  b.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
  b.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1, info.pMemoryBarriers = &b;
  vkCmdPipelineBarrier2(handle_, &info);
}

}  // namespace penumbra::gpu
