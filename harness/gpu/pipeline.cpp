#include "gpu/pipeline.h"

#include <utility>

#include "gpu/device.h"
#include "gpu/pipeline_detail.h"

namespace penumbra::gpu {

VkShaderModule shader_module(Device& device, Spirv code) {
  VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = code.size_bytes(), info.pCode = code.data();
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device.handle(), &info, nullptr, &module), "shader module");
  return module;
}

SpecializationData::SpecializationData(std::span<const Specialization> constants) {
  for (const Specialization& c : constants) {
    entries.push_back({c.id, static_cast<uint32_t>(values.size() * sizeof(uint32_t)), sizeof(uint32_t)});
    values.push_back(c.value);
  }
  info.mapEntryCount = static_cast<uint32_t>(entries.size()), info.pMapEntries = entries.data();
  info.dataSize = values.size() * sizeof(uint32_t), info.pData = values.data();
}

namespace {

VkSampler create_sampler(Device& device, ImageUse use) {
  VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  const VkFilter filter = use == ImageUse::sampled_nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  info.magFilter = info.minFilter = filter;
  info.mipmapMode =
      use == ImageUse::sampled_linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.maxLod = VK_LOD_CLAMP_NONE;
  const bool compare = use == ImageUse::sampled_compare;
  const VkSamplerAddressMode address =
      compare ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.addressModeU = info.addressModeV = info.addressModeW = address;
  info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
  info.compareEnable = compare, info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  VkSampler sampler = VK_NULL_HANDLE;
  check(vkCreateSampler(device.handle(), &info, nullptr, &sampler), "sampler");
  return sampler;
}

VkDescriptorType descriptor_type(ImageUse use) {
  if (use == ImageUse::uniform_block) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  if (use == ImageUse::texels) return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
  return use == ImageUse::storage ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                  : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

}  // namespace

Pipeline::~Pipeline() {
  if (!device_) return;
  const VkDevice d = device_->handle();
  vkDestroyPipeline(d, pipeline_, nullptr);
  vkDestroyPipelineLayout(d, layout_, nullptr);
  vkDestroyDescriptorPool(d, pool_, nullptr);
  vkDestroyDescriptorSetLayout(d, set_layout_, nullptr);
  for (VkSampler s : samplers_) vkDestroySampler(d, s, nullptr);
}

Pipeline::Pipeline(Pipeline&& o) noexcept { *this = std::move(o); }

Pipeline& Pipeline::operator=(Pipeline&& o) noexcept {
  std::swap(device_, o.device_);
  std::swap(pipeline_, o.pipeline_);
  std::swap(layout_, o.layout_);
  std::swap(set_layout_, o.set_layout_);
  std::swap(pool_, o.pool_);
  std::swap(set_, o.set_);
  std::swap(image_uses_, o.image_uses_);
  std::swap(samplers_, o.samplers_);
  std::swap(bind_point_, o.bind_point_);
  std::swap(stages_, o.stages_);
  std::swap(push_bytes_, o.push_bytes_);
  return *this;
}

void Pipeline::create_layout(Device& device, std::span<const ImageUse> images, uint32_t push_bytes,
                             VkShaderStageFlags stages) {
  device_ = &device, push_bytes_ = push_bytes, stages_ = stages;
  image_uses_.assign(images.begin(), images.end());
  const VkDevice d = device.handle();
  VkPipelineLayoutCreateInfo layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  if (!images.empty()) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    std::vector<VkDescriptorPoolSize> sizes;
    for (ImageUse use : images) {
      const bool sampled = descriptor_type(use) == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
      samplers_.push_back(sampled ? create_sampler(device, use) : VK_NULL_HANDLE);
      bindings.push_back({static_cast<uint32_t>(bindings.size()), descriptor_type(use), 1, stages, nullptr});
      sizes.push_back({descriptor_type(use), 1});
    }
    VkDescriptorSetLayoutCreateInfo set{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.bindingCount = static_cast<uint32_t>(bindings.size()), set.pBindings = bindings.data();
    check(vkCreateDescriptorSetLayout(d, &set, nullptr, &set_layout_), "descriptor layout");
    VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.maxSets = 1, pool.poolSizeCount = static_cast<uint32_t>(sizes.size()),
    pool.pPoolSizes = sizes.data();
    check(vkCreateDescriptorPool(d, &pool, nullptr, &pool_), "descriptor pool");
    VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool_, allocate.descriptorSetCount = 1, allocate.pSetLayouts = &set_layout_;
    check(vkAllocateDescriptorSets(d, &allocate, &set_), "descriptor set");
    layout.setLayoutCount = 1, layout.pSetLayouts = &set_layout_;
  }
  const VkPushConstantRange range{stages, 0, push_bytes};
  if (push_bytes) layout.pushConstantRangeCount = 1, layout.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(d, &layout, nullptr, &layout_), "pipeline layout");
}

void Pipeline::bind_images(std::span<const VkImageView> views) {
  std::vector<VkDescriptorImageInfo> infos(views.size());
  std::vector<VkWriteDescriptorSet> writes(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    infos[i] = {samplers_[i], views[i], VK_IMAGE_LAYOUT_GENERAL};
    writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstSet = set_, writes[i].dstBinding = static_cast<uint32_t>(i), writes[i].descriptorCount = 1;
    writes[i].descriptorType = descriptor_type(image_uses_[i]), writes[i].pImageInfo = &infos[i];
  }
  vkUpdateDescriptorSets(device_->handle(), static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

void Pipeline::bind_texels(std::span<const VkBufferView> views) {
  std::vector<VkWriteDescriptorSet> writes(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstSet = set_, writes[i].dstBinding = static_cast<uint32_t>(i), writes[i].descriptorCount = 1;
    writes[i].descriptorType = descriptor_type(image_uses_[i]), writes[i].pTexelBufferView = &views[i];
  }
  vkUpdateDescriptorSets(device_->handle(), static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

void Pipeline::bind_block(const Buffer& buffer) {
  const VkDescriptorBufferInfo info{buffer.handle(), 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set_, write.dstBinding = static_cast<uint32_t>(image_uses_.size()) - 1;
  write.descriptorCount = 1, write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  write.pBufferInfo = &info;
  vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
}

ComputePipeline::ComputePipeline(Device& device, Spirv code, uint32_t push_bytes,
                                 std::span<const Specialization> constants,
                                 std::span<const ImageUse> images) {
  create_layout(device, images, push_bytes, VK_SHADER_STAGE_COMPUTE_BIT);
  const SpecializationData specialization(constants);
  VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.layout = layout_;
  info.stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT, info.stage.pName = "main";
  info.stage.module = shader_module(device, code), info.stage.pSpecializationInfo = &specialization.info;
  const VkResult r =
      vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline_);
  vkDestroyShaderModule(device.handle(), info.stage.module, nullptr);
  check(r, "compute pipeline");
}

}  // namespace penumbra::gpu
