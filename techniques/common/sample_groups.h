// Groups of neighbouring view samples, made on the device; see shaders/sample_groups.comp.
#pragma once
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/pipeline.h"

namespace penumbra {

class SampleGroups {
 public:
  // `lanes`: view samples of a group = lanes of a subgroup, a power of two from 4 to 32.
  // `in_lists`: for arrange() in place of record(), and for texel arrays in place of texel buffers.
  void setup(gpu::Device& device, uint32_t lanes, bool in_lists = false);
  // Groups that width x height pixels can make at most; each has `lanes` slots.
  uint32_t capacity(uint32_t width, uint32_t height) const;
  // A LightBasis; P' (w = 0: no view sample) and Ng per pixel. Not while commands are in flight.
  void bind(VkBufferView light, VkBufferView origin, VkBufferView normal);
  void bind(VkImageView light, VkImageView origin, VkImageView normal);
  struct Input {
    uint64_t slots = 0, group_count = 0;  // addresses: out; the count is to be 0 before
    uint32_t width = 0, height = 0;
    float slack = 0, depth_weight = 1;
  };
  void record(gpu::Commands& commands, const Input& in) const;
  // View samples that are in lists already, `lanes` slots per group: rearranged within each list, so that
  // groups are of neighbours. Addresses: list of each group; of each list its first group and its length.
  struct Lists {
    uint64_t slots = 0, group_lists = 0, first_groups = 0, lengths = 0;
    uint32_t groups = 0;
    float depth_weight = 1;
  };
  void arrange(gpu::Commands& commands, const Lists& in) const;

 private:
  uint32_t tiles_x(uint32_t width) const { return (width + tile_width_ - 1) / tile_width_; }
  uint32_t tiles(uint32_t width, uint32_t height) const {
    return tiles_x(width) * ((height + tile_height_ - 1) / tile_height_);
  }
  gpu::ComputePipeline pipeline_;
  uint32_t tile_width_ = 8, tile_height_ = 8;
};

}  // namespace penumbra
