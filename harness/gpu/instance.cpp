#include "gpu/instance.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstring>

#include "core/error.h"
#include "gpu/keep_drivers.h"

namespace penumbra::gpu {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto& messages = *static_cast<std::vector<std::string>*>(user);
  messages.emplace_back(data->pMessage);
  std::fprintf(stderr, "validation: %s\n", data->pMessage);
  return VK_FALSE;
}

bool layer_installed() {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  for (const VkLayerProperties& l : layers)
    if (std::strcmp(l.layerName, validation_layer) == 0) return true;
  return false;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(std::vector<std::string>* messages) {
  VkDebugUtilsMessengerCreateInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = on_message, info.pUserData = messages;
  return info;
}

std::string version_text(uint32_t v) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(v), VK_API_VERSION_MINOR(v), VK_API_VERSION_PATCH(v));
}

std::string missing_features(VkPhysicalDevice device, const VkPhysicalDeviceProperties& p) {
  if (p.apiVersion < VK_API_VERSION_1_3)
    return "it has Vulkan " + version_text(p.apiVersion) + ", 1.3 is needed";
  const Features f(device);
  if (!f.v12.bufferDeviceAddress) return "it lacks buffer device addresses";
  if (!f.v12.scalarBlockLayout) return "it lacks scalar block layout";
  if (!f.v13.dynamicRendering) return "it lacks dynamic rendering";
  if (!f.core.features.fragmentStoresAndAtomics) return "it lacks stores from fragment shaders";
  return "";
}

}  // namespace

Instance::Instance(bool validation) {
  VkApplicationInfo app{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO};
  app.pApplicationName = "penumbra", app.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &app;
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  if (validation) {
    if (!layer_installed())
      throw DeviceError(
          "validation is asked for, but the layer VK_LAYER_KHRONOS_validation is not installed "
          "(Debian, Ubuntu: vulkan-validationlayers).");
    info.enabledLayerCount = 1, info.ppEnabledLayerNames = &validation_layer;
    info.enabledExtensionCount = 1, info.ppEnabledExtensionNames = &extension;
  }
  if (const VkResult r = vkCreateInstance(&info, nullptr, &instance_); r != VK_SUCCESS)
    throw DeviceError(
        fmt::format("no Vulkan driver found (Vulkan error {}). Install one "
                    "(Debian, Ubuntu: mesa-vulkan-drivers has lavapipe).",
                    static_cast<int>(r)));
  keep_drivers();
  if (validation) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    const VkDebugUtilsMessengerCreateInfoEXT m = messenger_info(&messages_);
    check(create(instance_, &m, nullptr, &messenger_), "validation messenger");
  }
}

Instance::~Instance() {
  if (messenger_) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
  }
  if (instance_) vkDestroyInstance(instance_, nullptr);
}

std::vector<VkPhysicalDevice> Instance::physical_devices() const {
  uint32_t count = 0;
  vkEnumeratePhysicalDevices(instance_, &count, nullptr);
  std::vector<VkPhysicalDevice> out(count);
  vkEnumeratePhysicalDevices(instance_, &count, out.data());
  out.resize(count);
  return out;
}

Features::Features(VkPhysicalDevice device) {
  core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
  v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  core.pNext = &v11, v11.pNext = &v12, v12.pNext = &v13;
  vkGetPhysicalDeviceFeatures2(device, &core);
}

bool has_extension(VkPhysicalDevice device, const char* name) {
  uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> all(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, all.data());
  for (const VkExtensionProperties& e : all)
    if (std::strcmp(e.extensionName, name) == 0) return true;
  return false;
}

std::vector<DeviceInfo> describe(const std::vector<VkPhysicalDevice>& devices) {
  std::vector<DeviceInfo> out;
  for (VkPhysicalDevice d : devices) {
    VkPhysicalDeviceVulkan12Properties v12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES};
    VkPhysicalDeviceProperties2 p{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    p.pNext = &v12;
    vkGetPhysicalDeviceProperties2(d, &p);
    DeviceInfo info;
    info.index = static_cast<int>(out.size());
    info.name = p.properties.deviceName;
    info.driver = v12.driverName;
    info.driver_version = v12.driverInfo;
    info.api_version = version_text(p.properties.apiVersion);
    info.software = p.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    info.missing = missing_features(d, p.properties);
    out.push_back(info);
  }
  return out;
}

std::vector<DeviceInfo> list_devices() {
  try {
    const Instance instance(false);
    return describe(instance.physical_devices());
  } catch (const DeviceError&) {
    return {};
  }
}

}  // namespace penumbra::gpu
