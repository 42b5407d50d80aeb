// Recording commands. Every call is ordered after the one before it by barrier(): call it where data flows.
#pragma once
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"

namespace penumbra::gpu {

struct RenderTarget {
  VkImageView view = VK_NULL_HANDLE;
  VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_CLEAR;
  VkClearValue clear{};
};

class Commands {
 public:
  Commands(Device& device, VkCommandBuffer handle) : device_(device), handle_(handle) {}
  VkCommandBuffer handle() const { return handle_; }
  Device& device() const { return device_; }

  // Compute. Group counts over the device's limit in x spill into y: shaders take the linear index from
  // linear_group() of gpu/shaders/common.glsl and return when it is >= their count.
  void bind(const Pipeline& pipeline);
  void push(const Pipeline& pipeline, const void* data, std::size_t bytes);
  template <class T>
  void dispatch(const ComputePipeline& pipeline, const T& constants, uint64_t groups) {
    static_assert(std::is_trivially_copyable_v<T>);
    bind(pipeline);
    push(pipeline, &constants, sizeof constants);
    dispatch_groups(groups);
  }
  void dispatch_groups(uint64_t groups);
  // Group count from a buffer of 3 uint32 at `offset`.
  template <class T>
  void dispatch_indirect(const ComputePipeline& pipeline, const T& constants, const Buffer& counts,
                         uint64_t offset) {
    static_assert(std::is_trivially_copyable_v<T>);
    bind(pipeline);
    push(pipeline, &constants, sizeof constants);
    dispatch_indirect_groups(counts, offset);
  }
  void dispatch_indirect_groups(const Buffer& counts, uint64_t offset);

  // Graphics (dynamic rendering). The stencil aspect is attached when the depth format has one.
  void begin_rendering(uint32_t width, uint32_t height, std::span<const RenderTarget> colors,
                       const RenderTarget* depth, VkFormat depth_format = VK_FORMAT_UNDEFINED,
                       uint32_t layers = 1);
  void end_rendering();
  void set_viewport(float x, float y, float width, float height);
  void set_scissor(int x, int y, uint32_t width, uint32_t height);
  void set_depth_bias(float constant, float slope, float clamp = 0);
  void vertex_buffers(std::span<const VkBuffer> buffers);
  void draw_indexed(const Buffer& indices, uint32_t index_count, uint32_t instances = 1,
                    uint32_t first_index = 0);
  // One VkDrawIndexedIndirectCommand from `arguments` at `offset`.
  void draw_indexed_indirect(const Buffer& indices, const Buffer& arguments, uint64_t offset = 0);
  void draw(uint32_t vertices, uint32_t instances = 1, uint32_t first_vertex = 0);
  // Between begin_rendering and end_rendering: the whole stencil, whatever the load operation was.
  void clear_stencil(uint32_t value, uint32_t width, uint32_t height);

  // Transfers.
  void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset = 0,
            uint64_t to_offset = 0);
  void fill(const Buffer& buffer, uint32_t value, uint64_t offset = 0, uint64_t bytes = VK_WHOLE_SIZE);
  // Host bytes into the command stream; at most 65,536, a multiple of 4.
  void update(const Buffer& buffer, const void* data, uint64_t bytes, uint64_t offset = 0);
  // Mip 0; texels tightly packed from `offset`.
  void copy_image_to_buffer(const Image& image, const Buffer& buffer, VkImageAspectFlags aspect,
                            uint32_t layer = 0, uint64_t offset = 0);
  // Layer 0, mip 0; texels tightly packed from `offset`.
  void copy_buffer_to_image(const Buffer& buffer, const Image& image, VkImageAspectFlags aspect,
                            uint64_t offset = 0);

  // UNDEFINED -> GENERAL, contents lost. All images live in GENERAL.
  void initialise(const Image& image);
  // Everything before is finished and visible to everything after (all stages, host included).
  void barrier();

 private:
  Device& device_;
  VkCommandBuffer handle_;
};

}  // namespace penumbra::gpu
