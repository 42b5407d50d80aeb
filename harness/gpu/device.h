// The Vulkan device: chosen by name or index, headless, one queue. Vulkan 1.3 with buffer addresses and
// dynamic rendering; everything else is a capability to query.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace penumbra::gpu {

struct DeviceInfo {
  int index = 0;
  std::string name, driver, driver_version, api_version;
  bool software = false;  // a CPU implementation such as lavapipe
  std::string missing;    // why Penumbra cannot use it; empty when it can
};
// All devices the loader finds; empty when there is no loader or driver (never throws).
std::vector<DeviceInfo> list_devices();

// Throws DeviceError unless `select` (as in DeviceOptions) names a usable device; opens nothing.
void require_device(const std::string& select);

struct Capabilities {
  uint32_t subgroup_size = 0;
  uint64_t max_storage_buffer_range = 0;
  uint64_t max_allocation = 0;  // bytes in one allocation
  uint64_t heap_bytes = 0;      // the largest device-local heap
  uint32_t max_image_2d = 0;
  uint32_t max_texels = 0;  // of a buffer for fetching
  uint32_t max_workgroups_x = 0;
  bool conservative_rasterization = false;  // VK_EXT_conservative_rasterization, enabled when there
  bool geometry_shader = false, fragment_stores = false, logic_op = false, depth_clamp = false, int64 = false;
  bool unified_memory = false;  // device memory is mapped: the host mirror costs no copy
  float timestamp_period_ns = 0;
};

struct DeviceOptions {
  std::string select;       // name (substring) or index; empty: PENUMBRA_DEVICE, else the first
  bool validation = false;  // also switched on by PENUMBRA_VALIDATION=1
};

// PENUMBRA_AS_DISCRETE=1 drives a device that shares the host's memory as a discrete one is driven: memory
// not mapped, passes recorded together and timed by timestamps. For tests: lavapipe's times are wrong then.
class Device {
 public:
  // Throws DeviceError (nothing found, name unknown with the list, a needed feature missing).
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceInfo& info() const;
  const Capabilities& caps() const;
  VkDevice handle() const;
  VkPhysicalDevice physical() const;
  VkPipelineCache pipeline_cache() const;

  // Bytes now held by buffers and images, and the high-water mark since reset_peak().
  uint64_t allocated_bytes() const;
  uint64_t peak_bytes() const;
  void reset_peak();
  // An upper bound on allocated_bytes(); going over it throws PointError as a full device would. 0 = none. At
  // first what PENUMBRA_DEVICE_MEMORY_MIB says, if that is set.
  void set_memory_limit(uint64_t bytes);

  // Validation messages so far (warnings and errors), in order; empty when validation is off.
  const std::vector<std::string>& validation_messages() const;
  bool validation_enabled() const;

  // How GPU time is taken. Found out at start by timing a known load with both clocks: lavapipe's compute
  // timestamps are wrong, so there it is submit_and_fence.
  enum class Clock { timestamps, submit_and_fence };
  Clock clock() const;

  // Runs a command buffer to completion. Throws PointError when the device is lost.
  void submit_and_wait(VkCommandBuffer commands);
  VkCommandBuffer allocate_commands();
  void free_commands(VkCommandBuffer commands);

  struct Allocation;  // used by Buffer and Image
  VkDeviceMemory allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags wanted,
                          bool address, VkMemoryPropertyFlags* got, const std::string& what);
  void free(VkDeviceMemory memory, uint64_t bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Throws PointError (out of memory, device lost) or std::logic_error for anything else.
void check(VkResult result, const char* what);

}  // namespace penumbra::gpu
