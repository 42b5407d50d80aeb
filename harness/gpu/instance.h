// The Vulkan instance, what its devices offer, and the check of their clock. Internal to gpu/.
#pragma once
#include <vulkan/vulkan.h>

#include <string>
#include <vector>

#include "gpu/device.h"

namespace penumbra::gpu {

class Instance {
 public:
  // With validation: the Khronos layer, messages collected and also printed to standard error. Throws
  // DeviceError when there is no loader, or validation is asked for and the layer is not installed.
  explicit Instance(bool validation);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return instance_; }
  bool validation() const { return messenger_ != VK_NULL_HANDLE; }
  const std::vector<std::string>& messages() const { return messages_; }
  std::vector<VkPhysicalDevice> physical_devices() const;

 private:
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::vector<std::string> messages_;
};

// The features that a physical device offers, chained for vkCreateDevice.
struct Features {
  explicit Features(VkPhysicalDevice device);
  Features(const Features&) = delete;
  Features& operator=(const Features&) = delete;
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan11Features v11{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceVulkan13Features v13{};
};

bool has_extension(VkPhysicalDevice device, const char* name);
std::vector<DeviceInfo> describe(const std::vector<VkPhysicalDevice>& devices);

// Times a load of some milliseconds with the device's timestamps and with the host's clock around submit and
// fence. Timestamps are trusted when both agree within 20 % (or the host's extra is below 0.2 ms), and never
// on a software device.
Device::Clock probe_clock(Device& device);

}  // namespace penumbra::gpu
