// Buffers and images: owning handles. Shaders reach buffers by address (GL_EXT_buffer_reference), never by
// descriptor: so no range limit (maxStorageBufferRange is 128 MiB on lavapipe) and no descriptor sets. (A
// pass's constants may also be bound as a uniform block, see pipeline.h.)
#pragma once
#include <vulkan/vulkan.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace penumbra::gpu {

class Device;

enum class Memory {
  device,     // device-local; mapped too where the device shares memory with the host
  upload,     // host-visible, written by the host
  read_back,  // host-visible and cached, read by the host
};

class Buffer {
 public:
  Buffer() = default;
  // Usage: storage, uniform, texels, vertex, index, indirect, transfer both ways, device address. Throws
  // PointError when out of memory, naming `what` and the bytes.
  Buffer(Device& device, std::size_t bytes, Memory memory, const std::string& what);
  ~Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;

  explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }
  VkBuffer handle() const { return buffer_; }
  VkDeviceAddress address() const { return address_; }
  std::size_t bytes() const { return bytes_; }
  // Differs from that of any other buffer, those freed included; 0 without one.
  uint64_t id() const { return id_; }
  // Null when the memory is not visible to the host.
  void* mapped() const { return mapped_; }
  template <class T>
  std::span<T> view() const {
    return {static_cast<T*>(mapped_), mapped_ ? bytes_ / sizeof(T) : 0};
  }

 private:
  Device* device_ = nullptr;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkDeviceAddress address_ = 0;
  uint64_t id_ = 0;
  std::size_t bytes_ = 0, allocated_ = 0;
  void* mapped_ = nullptr;
};

// The vec4 of a buffer for texelFetch (ImageUse::texels): on lavapipe several times cheaper than reading them
// by address, and cheaper than from an image, which has levels, rows and tiles to find; and nothing is
// copied.
class TexelView {
 public:
  TexelView() = default;
  ~TexelView();
  TexelView(TexelView&&) noexcept;
  TexelView& operator=(TexelView&&) noexcept;

  // Of the whole `buffer`; does nothing where it is that already. True when the view is new, and has to be
  // bound anew. Throws PointError when the buffer has more texels than the device can fetch from.
  bool set(Device& device, const Buffer& buffer, const std::string& what);
  VkBufferView handle() const { return view_; }

 private:
  Device* device_ = nullptr;
  VkBufferView view_ = VK_NULL_HANDLE;
  uint64_t of_ = 0;
};

// Grows `buffer` to at least `bytes` (contents are lost); never shrinks. True when it was reallocated.
bool ensure(Buffer& buffer, Device& device, std::size_t bytes, Memory memory, const std::string& what);

struct ImageDesc {
  uint32_t width = 1, height = 1, layers = 1, mips = 1;
  VkFormat format = VK_FORMAT_R32_SFLOAT;
  VkImageUsageFlags usage = 0;
  bool cube = false;
  bool array = false;  // view as an array even when layers == 1
};

// An optimally tiled 2-D image (array), one sample per pixel, with a view of the whole and one per layer.
class Image {
 public:
  Image() = default;
  Image(Device& device, const ImageDesc& desc, const std::string& what);
  ~Image();
  Image(Image&&) noexcept;
  Image& operator=(Image&&) noexcept;

  explicit operator bool() const { return image_ != VK_NULL_HANDLE; }
  const ImageDesc& desc() const { return desc_; }
  VkImage handle() const { return image_; }
  VkImageView view() const { return view_; }
  // For rendering into or sampling one layer and mip. Created on first use.
  VkImageView view(uint32_t layer, uint32_t mip = 0) const;
  VkImageAspectFlags aspect() const;
  std::size_t bytes() const { return allocated_; }

 private:
  void release();
  Device* device_ = nullptr;
  ImageDesc desc_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  mutable std::vector<VkImageView> part_views_;
  std::size_t allocated_ = 0;
};

}  // namespace penumbra::gpu
