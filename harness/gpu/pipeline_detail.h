// Shared by compute and graphics pipelines. Internal to gpu/.
#pragma once
#include <vulkan/vulkan.h>

#include <span>
#include <vector>

#include "gpu/pipeline.h"

namespace penumbra::gpu {

VkShaderModule shader_module(Device& device, Spirv code);

// Keeps the arrays behind a VkSpecializationInfo alive; not copyable, since `info` points into it.
struct SpecializationData {
  explicit SpecializationData(std::span<const Specialization> constants);
  SpecializationData(const SpecializationData&) = delete;
  SpecializationData& operator=(const SpecializationData&) = delete;
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<uint32_t> values;
  VkSpecializationInfo info{};
};

}  // namespace penumbra::gpu
