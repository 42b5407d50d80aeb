// Compute and graphics pipelines. Parameters travel as push constants (at most 128 bytes: addresses of
// buffers, a few numbers); images, where a pass samples or stores to them, as one set of combined image
// samplers / storage images; constants that do not fit, as a uniform block behind the images of that set (on
// lavapipe the one way to read what is the same for all lanes once, not lane by lane).
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/buffer.h"

namespace penumbra::gpu {

class Device;
using Spirv = std::span<const uint32_t>;

struct Specialization {
  uint32_t id;
  uint32_t value;  // bits of an int, uint, bool or float constant
};

// Binding i of set 0. Images must be in GENERAL layout.
enum class ImageUse { sampled_nearest, sampled_linear, sampled_compare, storage, texels, uniform_block };
// sampled_compare: LESS_OR_EQUAL with linear filtering, clamp to a border of 1; the others clamp to edge.
// texels: no image but a buffer's vec4 (samplerBuffer). uniform_block: no image but a uniform buffer (std140,
// at most 16 KiB); after all images.

class Pipeline {
 public:
  Pipeline() = default;
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;
  explicit operator bool() const { return pipeline_ != VK_NULL_HANDLE; }

  VkPipeline handle() const { return pipeline_; }
  VkPipelineLayout layout() const { return layout_; }
  VkPipelineBindPoint bind_point() const { return bind_point_; }
  VkShaderStageFlags push_stages() const { return stages_; }
  uint32_t push_bytes() const { return push_bytes_; }

  // Images for bindings 0, 1, ... of set 0; whole views unless a view is given. Not while commands are in
  // flight.
  void bind_images(std::span<const VkImageView> views);
  // The same for a set that begins with buffers of texels.
  void bind_texels(std::span<const VkBufferView> views);
  // The buffer of the uniform_block, whole. Under the same rule.
  void bind_block(const Buffer& buffer);
  VkDescriptorSet descriptors() const { return set_; }

 protected:
  void create_layout(Device& device, std::span<const ImageUse> images, uint32_t push_bytes,
                     VkShaderStageFlags stages);
  Device* device_ = nullptr;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  std::vector<ImageUse> image_uses_;
  std::vector<VkSampler> samplers_;
  VkPipelineBindPoint bind_point_ = VK_PIPELINE_BIND_POINT_COMPUTE;
  VkShaderStageFlags stages_ = 0;
  uint32_t push_bytes_ = 0;
};

class ComputePipeline : public Pipeline {
 public:
  ComputePipeline() = default;
  ComputePipeline(Device& device, Spirv code, uint32_t push_bytes,
                  std::span<const Specialization> constants = {}, std::span<const ImageUse> images = {});
};

struct GraphicsDesc {
  Spirv vertex, geometry, fragment;  // geometry, fragment: may be empty
  uint32_t push_bytes = 0;
  std::vector<Specialization> constants;  // given to all stages
  std::vector<ImageUse> images;
  std::vector<uint32_t> vertex_strides;  // binding i: tightly packed floats, stride bytes; location i
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  std::vector<VkFormat> color_formats;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;  // may carry stencil
  VkCullModeFlags cull = VK_CULL_MODE_NONE;     // front = counter-clockwise in world seen from the camera
  bool depth_test = false, depth_write = false, depth_clamp = false, conservative = false;
  VkCompareOp depth_compare = VK_COMPARE_OP_GREATER;
  bool depth_bias = false;  // values set by Commands::set_depth_bias
  bool stencil_test = false;
  VkStencilOpState stencil_front{}, stencil_back{};
  VkLogicOp logic_op = VK_LOGIC_OP_NO_OP;  // NO_OP: off
  bool blend_add = false;                  // dst + src on all channels
  VkBlendOp blend_op = VK_BLEND_OP_ADD;    // with blend_add: ADD, MIN or MAX
  VkColorComponentFlags write_mask = 0xf;
};

// Viewport and scissor are dynamic (Commands::begin_rendering sets them to the whole target).
class GraphicsPipeline : public Pipeline {
 public:
  GraphicsPipeline() = default;
  GraphicsPipeline(Device& device, const GraphicsDesc& desc);
};

}  // namespace penumbra::gpu
