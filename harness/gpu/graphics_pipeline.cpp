#include <array>

#include "gpu/device.h"
#include "gpu/pipeline.h"
#include "gpu/pipeline_detail.h"

namespace penumbra::gpu {
namespace {

// The fixed-function state of one GraphicsDesc; the create info points into it.
struct State {
  explicit State(const GraphicsDesc& desc, const Capabilities& caps);
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
  std::vector<VkPipelineColorBlendAttachmentState> attachments;
  std::vector<VkDynamicState> dynamics{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineVertexInputStateCreateInfo vertex{.sType =
                                                  VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkPipelineViewportStateCreateInfo viewport{.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  VkPipelineRasterizationConservativeStateCreateInfoEXT conservative{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_CONSERVATIVE_STATE_CREATE_INFO_EXT};
  VkPipelineMultisampleStateCreateInfo samples{.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  VkPipelineDepthStencilStateCreateInfo depth{.sType =
                                                  VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineColorBlendStateCreateInfo blend{.sType =
                                                VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};

 private:
  void vertex_input(const GraphicsDesc& desc);
  void rasterization(const GraphicsDesc& desc, const Capabilities& caps);
  void output(const GraphicsDesc& desc);
};

bool has_stencil(VkFormat f) {
  return f == VK_FORMAT_D32_SFLOAT_S8_UINT || f == VK_FORMAT_D24_UNORM_S8_UINT ||
         f == VK_FORMAT_D16_UNORM_S8_UINT || f == VK_FORMAT_S8_UINT;
}

State::State(const GraphicsDesc& desc, const Capabilities& caps) {
  vertex_input(desc);
  rasterization(desc, caps);
  output(desc);
}

void State::vertex_input(const GraphicsDesc& desc) {
  constexpr std::array formats{VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
                               VK_FORMAT_R32G32B32A32_SFLOAT};
  for (uint32_t i = 0; i < desc.vertex_strides.size(); ++i) {
    bindings.push_back({i, desc.vertex_strides[i], VK_VERTEX_INPUT_RATE_VERTEX});
    attributes.push_back({i, i, formats[desc.vertex_strides[i] / 4 - 1], 0});
  }
  vertex.vertexBindingDescriptionCount = static_cast<uint32_t>(bindings.size());
  vertex.pVertexBindingDescriptions = bindings.data();
  vertex.vertexAttributeDescriptionCount = static_cast<uint32_t>(attributes.size());
  vertex.pVertexAttributeDescriptions = attributes.data();
  assembly.topology = desc.topology;
}

void State::rasterization(const GraphicsDesc& desc, const Capabilities& caps) {
  viewport.viewportCount = 1, viewport.scissorCount = 1;
  raster.depthClampEnable = desc.depth_clamp, raster.polygonMode = VK_POLYGON_MODE_FILL;
  raster.cullMode = desc.cull, raster.lineWidth = 1;
  // Camera::clip_from_world flips y for Vulkan's y-down clip space; counter-clockwise in the world stays
  // counter-clockwise in the picture, which Vulkan, measuring with y down, calls clockwise... of a flipped y:
  // so the winding seen by the eye is the winding that the framebuffer has.
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.depthBiasEnable = desc.depth_bias;
  if (desc.depth_bias) dynamics.push_back(VK_DYNAMIC_STATE_DEPTH_BIAS);
  if (desc.conservative && caps.conservative_rasterization) {
    conservative.conservativeRasterizationMode = VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT;
    raster.pNext = &conservative;
  }
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
}

void State::output(const GraphicsDesc& desc) {
  depth.depthTestEnable = desc.depth_test || desc.depth_write, depth.depthWriteEnable = desc.depth_write;
  depth.depthCompareOp = desc.depth_test ? desc.depth_compare : VK_COMPARE_OP_ALWAYS;
  depth.stencilTestEnable = desc.stencil_test, depth.front = desc.stencil_front,
  depth.back = desc.stencil_back;
  VkPipelineColorBlendAttachmentState a{};
  a.colorWriteMask = desc.write_mask, a.blendEnable = desc.blend_add;
  a.srcColorBlendFactor = a.dstColorBlendFactor = a.srcAlphaBlendFactor = a.dstAlphaBlendFactor =
      VK_BLEND_FACTOR_ONE;
  a.colorBlendOp = a.alphaBlendOp = desc.blend_op;
  attachments.assign(desc.color_formats.size(), a);
  blend.attachmentCount = static_cast<uint32_t>(attachments.size()), blend.pAttachments = attachments.data();
  blend.logicOpEnable = desc.logic_op != VK_LOGIC_OP_NO_OP, blend.logicOp = desc.logic_op;
  dynamic.dynamicStateCount = static_cast<uint32_t>(dynamics.size()),
  dynamic.pDynamicStates = dynamics.data();
  rendering.colorAttachmentCount = static_cast<uint32_t>(desc.color_formats.size());
  rendering.pColorAttachmentFormats = desc.color_formats.data();
  rendering.depthAttachmentFormat =
      desc.depth_format == VK_FORMAT_S8_UINT ? VK_FORMAT_UNDEFINED : desc.depth_format;
  rendering.stencilAttachmentFormat =
      has_stencil(desc.depth_format) ? desc.depth_format : VK_FORMAT_UNDEFINED;
}

}  // namespace

GraphicsPipeline::GraphicsPipeline(Device& device, const GraphicsDesc& desc) {
  bind_point_ = VK_PIPELINE_BIND_POINT_GRAPHICS;
  const SpecializationData specialization(desc.constants);
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  VkShaderStageFlags used = 0;
  const auto add = [&](Spirv code, VkShaderStageFlagBits stage) {
    if (code.empty()) return;
    VkPipelineShaderStageCreateInfo s{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    s.stage = stage, s.module = shader_module(device, code), s.pName = "main";
    s.pSpecializationInfo = &specialization.info;
    stages.push_back(s);
    used |= stage;
  };
  add(desc.vertex, VK_SHADER_STAGE_VERTEX_BIT);
  add(desc.geometry, VK_SHADER_STAGE_GEOMETRY_BIT);
  add(desc.fragment, VK_SHADER_STAGE_FRAGMENT_BIT);
  create_layout(device, desc.images, desc.push_bytes, used);
  const State state(desc, device.caps());
  VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.pNext = &state.rendering;
  info.stageCount = static_cast<uint32_t>(stages.size()), info.pStages = stages.data();
  info.pVertexInputState = &state.vertex, info.pInputAssemblyState = &state.assembly;
  info.pViewportState = &state.viewport, info.pRasterizationState = &state.raster;
  info.pMultisampleState = &state.samples, info.pDepthStencilState = &state.depth;
  info.pColorBlendState = &state.blend, info.pDynamicState = &state.dynamic;
  info.layout = layout_;
  const VkResult r =
      vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &pipeline_);
  for (const VkPipelineShaderStageCreateInfo& s : stages)
    vkDestroyShaderModule(device.handle(), s.module, nullptr);
  check(r, "graphics pipeline");
}

}  // namespace penumbra::gpu
