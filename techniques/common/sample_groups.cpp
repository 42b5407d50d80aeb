#include "techniques/common/sample_groups.h"

#include "shaders/sample_groups.h"
#include "shaders/sample_groups_of_buffers.h"
#include "techniques/common/shaders/constants.h"

namespace penumbra {
namespace {

constexpr uint32_t levels_of_cuts = 3, per_lane = 1u << levels_of_cuts;

}  // namespace

void SampleGroups::setup(gpu::Device& device, uint32_t lanes, bool in_lists) {
  tile_height_ = 1;
  while (tile_height_ * tile_height_ * 2 <= per_lane * lanes) tile_height_ *= 2;
  if (tile_height_ * tile_height_ > per_lane * lanes) tile_height_ /= 2;
  tile_width_ = per_lane * lanes / tile_height_;
  const gpu::Specialization constants[] = {
      {0, lanes}, {1, tile_width_}, {2, tile_height_}, {3, levels_of_cuts}, {4, in_lists}};
  const gpu::Spirv code = in_lists ? gpu::Spirv(sample_groups_spv) : gpu::Spirv(sample_groups_of_buffers_spv);
  const std::vector<gpu::ImageUse> arrays(3,
                                          in_lists ? gpu::ImageUse::sampled_nearest : gpu::ImageUse::texels);
  pipeline_ = gpu::ComputePipeline(device, code, sizeof(SampleGroupsConstants), constants, arrays);
}

void SampleGroups::bind(VkBufferView light, VkBufferView origin, VkBufferView normal) {
  pipeline_.bind_texels(std::vector<VkBufferView>{light, origin, normal});
}

void SampleGroups::bind(VkImageView light, VkImageView origin, VkImageView normal) {
  pipeline_.bind_images(std::vector<VkImageView>{light, origin, normal});
}

uint32_t SampleGroups::capacity(uint32_t width, uint32_t height) const {
  return tiles(width, height) * per_lane;
}

void SampleGroups::record(gpu::Commands& commands, const Input& in) const {
  SampleGroupsConstants pc{};
  pc.slots = in.slots;
  pc.group_count = in.group_count;
  pc.width = in.width;
  pc.height = in.height;
  pc.tiles_x = tiles_x(in.width);
  pc.tiles = tiles(in.width, in.height);
  pc.slack = in.slack;
  pc.depth_weight = in.depth_weight;
  commands.dispatch(pipeline_, pc, pc.tiles);
}

void SampleGroups::arrange(gpu::Commands& commands, const Lists& in) const {
  SampleGroupsConstants pc{};
  pc.slots = in.slots;
  pc.group_lists = in.group_lists;
  pc.first_groups = in.first_groups;
  pc.lengths = in.lengths;
  pc.tiles_x = 1;
  pc.tiles = in.groups;
  pc.depth_weight = in.depth_weight;
  commands.dispatch(pipeline_, pc, pc.tiles);
}

}  // namespace penumbra
