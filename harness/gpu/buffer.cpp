#include "gpu/buffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <utility>

#include "core/error.h"
#include "gpu/device.h"

namespace penumbra::gpu {
namespace {

constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT |
                                     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                     VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                     VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;

constexpr std::size_t texel_bytes = 16;

constexpr VkMemoryPropertyFlags host_memory =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

VkMemoryPropertyFlags properties(Memory memory, bool unified) {
  switch (memory) {
    case Memory::upload:
      return host_memory;
    case Memory::read_back:
      return host_memory | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    case Memory::device:
      break;
  }
  return VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT |
         (unified ? host_memory | VK_MEMORY_PROPERTY_HOST_CACHED_BIT : 0U);
}

uint64_t next_id() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

}  // namespace

Buffer::Buffer(Device& device, std::size_t bytes, Memory memory, const std::string& what)
    : device_(&device), id_(next_id()), bytes_(std::max<std::size_t>(bytes, 16)) {
  VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes_, info.usage = usage;
  check(vkCreateBuffer(device.handle(), &info, nullptr, &buffer_), what.c_str());
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device.handle(), buffer_, &requirements);
  VkMemoryPropertyFlags got = 0;
  try {
    memory_ =
        device.allocate(requirements, properties(memory, device.caps().unified_memory), true, &got, what);
  } catch (...) {
    vkDestroyBuffer(device.handle(), buffer_, nullptr);
    throw;
  }
  allocated_ = requirements.size;
  check(vkBindBufferMemory(device.handle(), buffer_, memory_, 0), what.c_str());
  const bool map = memory != Memory::device || device.caps().unified_memory;
  if (map) check(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_), what.c_str());
  VkBufferDeviceAddressInfo address{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  address.buffer = buffer_;
  address_ = vkGetBufferDeviceAddress(device.handle(), &address);
}

Buffer::~Buffer() {
  if (!buffer_) return;
  vkDestroyBuffer(device_->handle(), buffer_, nullptr);
  device_->free(memory_, allocated_);
}

Buffer::Buffer(Buffer&& o) noexcept { *this = std::move(o); }

Buffer& Buffer::operator=(Buffer&& o) noexcept {
  std::swap(device_, o.device_);
  std::swap(buffer_, o.buffer_);
  std::swap(memory_, o.memory_);
  std::swap(address_, o.address_);
  std::swap(id_, o.id_);
  std::swap(bytes_, o.bytes_);
  std::swap(allocated_, o.allocated_);
  std::swap(mapped_, o.mapped_);
  return *this;
}

TexelView::~TexelView() {
  if (view_) vkDestroyBufferView(device_->handle(), view_, nullptr);
}

TexelView::TexelView(TexelView&& o) noexcept { *this = std::move(o); }

TexelView& TexelView::operator=(TexelView&& o) noexcept {
  std::swap(device_, o.device_);
  std::swap(view_, o.view_);
  std::swap(of_, o.of_);
  return *this;
}

bool TexelView::set(Device& device, const Buffer& buffer, const std::string& what) {
  if (view_ && of_ == buffer.id()) return false;
  const std::size_t count = buffer.bytes() / texel_bytes;
  if (count > device.caps().max_texels)
    throw PointError(fmt::format("{} takes {} texels; this device fetches from at most {}.", what, count,
                                 device.caps().max_texels));
  *this = TexelView();
  VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = buffer.handle(), info.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  info.range = count * texel_bytes;
  check(vkCreateBufferView(device.handle(), &info, nullptr, &view_), what.c_str());
  device_ = &device;
  of_ = buffer.id();
  return true;
}

bool ensure(Buffer& buffer, Device& device, std::size_t bytes, Memory memory, const std::string& what) {
  if (buffer && buffer.bytes() >= bytes) return false;
  buffer = Buffer();  // free first: both at once might not fit
  buffer = Buffer(device, bytes, memory, what);
  return true;
}

}  // namespace penumbra::gpu
