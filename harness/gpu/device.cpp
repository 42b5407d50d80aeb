#include "gpu/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "core/error.h"
#include "gpu/instance.h"

namespace penumbra::gpu {

void check(VkResult result, const char* what) {
  if (result >= VK_SUCCESS) return;
  switch (result) {
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      throw PointError(fmt::format("{}: out of device memory", what));
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      throw PointError(fmt::format("{}: out of host memory", what));
    case VK_ERROR_DEVICE_LOST:
      throw PointError(fmt::format("{}: the device was lost", what));
    default:
      throw std::logic_error(fmt::format("{}: Vulkan error {}", what, static_cast<int>(result)));
  }
}

struct Device::Impl {
  Instance instance;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family = 0;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkPipelineCache cache = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
  VkPhysicalDeviceMemoryProperties memory{};
  DeviceInfo info;
  Capabilities caps;
  uint64_t allocated = 0, peak = 0, limit = 0;
  Clock clock = Clock::submit_and_fence;

  explicit Impl(bool validation) : instance(validation) {}
  ~Impl() {
    if (!device) return;
    vkDeviceWaitIdle(device);
    vkDestroyFence(device, fence, nullptr);
    vkDestroyPipelineCache(device, cache, nullptr);
    vkDestroyCommandPool(device, pool, nullptr);
    vkDestroyDevice(device, nullptr);
  }
  void create_device();
  void query_caps();
};

namespace {

// The first family that can do graphics and compute; such a family can transfer too.
uint32_t queue_family(VkPhysicalDevice device) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  constexpr VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & wanted) == wanted) return i;
  throw DeviceError("the device has no queue for graphics and compute");
}

std::vector<const char*> wanted_extensions(VkPhysicalDevice device) {
  std::vector<const char*> out;
  if (has_extension(device, VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME))
    out.push_back(VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME);
  return out;
}

// Which of the listed devices `select` means: an index, or a part of the name.
int choose(const std::vector<DeviceInfo>& devices, std::string select) {
  if (devices.empty())
    throw DeviceError(
        "no Vulkan device found. Install a driver (Debian, Ubuntu: mesa-vulkan-drivers has lavapipe).");
  if (select.empty())
    if (const char* env = std::getenv("PENUMBRA_DEVICE")) select = env;
  std::string all;
  for (const DeviceInfo& d : devices) all += fmt::format("\n  {}: {} ({})", d.index, d.name, d.driver);
  int chosen = -1;
  if (select.empty()) chosen = 0;
  const bool number = !select.empty() &&
                      std::all_of(select.begin(), select.end(), [](char c) { return c >= '0' && c <= '9'; });
  for (const DeviceInfo& d : devices)
    if (chosen < 0 && (number ? std::to_string(d.index) == select : d.name.find(select) != std::string::npos))
      chosen = d.index;
  if (chosen < 0) throw DeviceError(fmt::format("no device '{}'. Devices:{}", select, all));
  const DeviceInfo& d = devices[static_cast<std::size_t>(chosen)];
  if (!d.missing.empty())
    throw DeviceError(fmt::format("device '{}' cannot be used: {}. Devices:{}", d.name, d.missing, all));
  return chosen;
}

}  // namespace

void require_device(const std::string& select) { choose(list_devices(), select); }

void Device::Impl::create_device() {
  family = queue_family(physical);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue_info{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_info.queueFamilyIndex = family, queue_info.queueCount = 1, queue_info.pQueuePriorities = &priority;
  Features features(physical);
  features.core.features.robustBufferAccess = VK_FALSE;  // costs time; techniques must not rely on it
  const std::vector<const char*> extensions = wanted_extensions(physical);
  VkDeviceCreateInfo create{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  create.pNext = &features.core;
  create.queueCreateInfoCount = 1, create.pQueueCreateInfos = &queue_info;
  create.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  create.ppEnabledExtensionNames = extensions.data();
  if (const VkResult r = vkCreateDevice(physical, &create, nullptr, &device); r != VK_SUCCESS)
    throw DeviceError(
        fmt::format("device '{}' could not be opened (Vulkan error {})", info.name, static_cast<int>(r)));
  vkGetDeviceQueue(device, family, 0, &queue);
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool_info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool_info.queueFamilyIndex = family;
  check(vkCreateCommandPool(device, &pool_info, nullptr, &pool), "command pool");
  VkPipelineCacheCreateInfo cache_info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  check(vkCreatePipelineCache(device, &cache_info, nullptr, &cache), "pipeline cache");
  VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  check(vkCreateFence(device, &fence_info, nullptr, &fence), "fence");
}

void Device::Impl::query_caps() {
  VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties v11{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  v11.pNext = &subgroup;
  VkPhysicalDeviceProperties2 p{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
  p.pNext = &v11;
  vkGetPhysicalDeviceProperties2(physical, &p);
  const VkPhysicalDeviceLimits& limits = p.properties.limits;
  caps.subgroup_size = subgroup.subgroupSize;
  caps.max_storage_buffer_range = limits.maxStorageBufferRange;
  caps.max_allocation = v11.maxMemoryAllocationSize;
  caps.max_image_2d = limits.maxImageDimension2D;
  caps.max_texels = limits.maxTexelBufferElements;
  caps.max_workgroups_x = limits.maxComputeWorkGroupCount[0];
  caps.timestamp_period_ns = limits.timestampComputeAndGraphics ? limits.timestampPeriod : 0;
  caps.conservative_rasterization = has_extension(physical, VK_EXT_CONSERVATIVE_RASTERIZATION_EXTENSION_NAME);
  const VkPhysicalDeviceFeatures f = Features(physical).core.features;
  caps.geometry_shader = f.geometryShader, caps.fragment_stores = f.fragmentStoresAndAtomics;
  caps.logic_op = f.logicOp, caps.depth_clamp = f.depthClamp, caps.int64 = f.shaderInt64;
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      caps.heap_bytes = std::max<uint64_t>(caps.heap_bytes, memory.memoryHeaps[i].size);
  // Unified: every device-local type is visible and cached, as on lavapipe. A small mappable window of a
  // discrete device does not count: reading through it would be slower than a staged copy.
  caps.unified_memory = true;
  for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    constexpr VkMemoryPropertyFlags all = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                          VK_MEMORY_PROPERTY_HOST_COHERENT_BIT |
                                          VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    const VkMemoryPropertyFlags flags = memory.memoryTypes[i].propertyFlags;
    if ((flags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT) && (flags & all) != all) caps.unified_memory = false;
  }
}

// Of the environment's PENUMBRA_DEVICE_MEMORY_MIB, in bytes.
static uint64_t mebibytes(const std::string& text) {
  if (text.empty() || text.size() > 9 || text.find_first_not_of("0123456789") != std::string::npos ||
      std::stoull(text) == 0)
    throw DeviceError(
        fmt::format("PENUMBRA_DEVICE_MEMORY_MIB: found '{}', expected a number of MiB from 1 on.", text));
  return std::stoull(text) << 20;
}

Device::Device(const DeviceOptions& options) {
  const char* env = std::getenv("PENUMBRA_VALIDATION");
  impl_ = std::make_unique<Impl>(options.validation || (env && std::strcmp(env, "1") == 0));
  const std::vector<VkPhysicalDevice> all = impl_->instance.physical_devices();
  const std::vector<DeviceInfo> infos = describe(all);
  const auto chosen = static_cast<std::size_t>(choose(infos, options.select));
  impl_->physical = all[chosen], impl_->info = infos[chosen];
  impl_->create_device();
  impl_->query_caps();
  impl_->clock = probe_clock(*this);
  const char* discrete = std::getenv("PENUMBRA_AS_DISCRETE");
  if (discrete && std::strcmp(discrete, "1") == 0) {
    impl_->caps.unified_memory = false;
    impl_->clock = Clock::timestamps;
  }
  if (const char* most = std::getenv("PENUMBRA_DEVICE_MEMORY_MIB")) impl_->limit = mebibytes(most);
}

Device::~Device() = default;

const DeviceInfo& Device::info() const { return impl_->info; }
const Capabilities& Device::caps() const { return impl_->caps; }
VkDevice Device::handle() const { return impl_->device; }
VkPhysicalDevice Device::physical() const { return impl_->physical; }
VkPipelineCache Device::pipeline_cache() const { return impl_->cache; }
uint64_t Device::allocated_bytes() const { return impl_->allocated; }
uint64_t Device::peak_bytes() const { return impl_->peak; }
void Device::reset_peak() { impl_->peak = impl_->allocated; }
void Device::set_memory_limit(uint64_t bytes) { impl_->limit = bytes; }
const std::vector<std::string>& Device::validation_messages() const { return impl_->instance.messages(); }
bool Device::validation_enabled() const { return impl_->instance.validation(); }
Device::Clock Device::clock() const { return impl_->clock; }

void Device::submit_and_wait(VkCommandBuffer commands) {
  VkSubmitInfo submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1, submit.pCommandBuffers = &commands;
  check(vkQueueSubmit(impl_->queue, 1, &submit, impl_->fence), "submit");
  check(vkWaitForFences(impl_->device, 1, &impl_->fence, VK_TRUE, UINT64_MAX), "wait for the device");
  check(vkResetFences(impl_->device, 1, &impl_->fence), "reset fence");
}

VkCommandBuffer Device::allocate_commands() {
  VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = impl_->pool, info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY, info.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(impl_->device, &info, &commands), "command buffer");
  return commands;
}

void Device::free_commands(VkCommandBuffer commands) {
  vkFreeCommandBuffers(impl_->device, impl_->pool, 1, &commands);
}

VkDeviceMemory Device::allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags wanted,
                                bool address, VkMemoryPropertyFlags* got, const std::string& what) {
  const auto refuse = [&](const std::string& why) {
    throw PointError(fmt::format("{} needs {:.1f} MiB of device memory: {}", what,
                                 double(requirements.size) / (1 << 20), why));
  };
  if (requirements.size > impl_->caps.max_allocation)
    refuse(fmt::format("one allocation may have {:.1f} MiB", double(impl_->caps.max_allocation) / (1 << 20)));
  if (impl_->limit && impl_->allocated + requirements.size > impl_->limit)
    refuse(fmt::format("{:.1f} of {:.1f} MiB are in use", double(impl_->allocated) / (1 << 20),
                       double(impl_->limit) / (1 << 20)));
  VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = address ? VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT : 0;
  VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.pNext = &flags, info.allocationSize = requirements.size;
  for (uint32_t i = 0; i < impl_->memory.memoryTypeCount; ++i) {
    const VkMemoryPropertyFlags properties = impl_->memory.memoryTypes[i].propertyFlags;
    if (!(requirements.memoryTypeBits >> i & 1U) || (properties & wanted) != wanted) continue;
    info.memoryTypeIndex = i;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    const VkResult r = vkAllocateMemory(impl_->device, &info, nullptr, &memory);
    if (r == VK_ERROR_OUT_OF_DEVICE_MEMORY || r == VK_ERROR_OUT_OF_HOST_MEMORY) continue;
    check(r, what.c_str());
    impl_->allocated += requirements.size;
    impl_->peak = std::max(impl_->peak, impl_->allocated);
    if (got) *got = properties;
    return memory;
  }
  refuse("the device has no more");
  return VK_NULL_HANDLE;
}

void Device::free(VkDeviceMemory memory, uint64_t bytes) {
  if (!memory) return;
  vkFreeMemory(impl_->device, memory, nullptr);
  impl_->allocated -= bytes;
}

}  // namespace penumbra::gpu
