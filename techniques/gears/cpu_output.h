// backend: cpu. Horizon before, visibility and mask after a view sample's triangles: between the kernel's
// masks and those that are handed out.
#pragma once
#include "techniques/common/host_masks.h"
#include "techniques/common/mask_layout.h"
#include "techniques/gears/cpu_kernel.h"

namespace penumbra::gears::cpu {

class MaskOutput final : public Masks {
 public:
  void set_light(const Light& light, const LightSamples& samples, const MaskLayout& layout);
  // For one frame.
  void bind(const ViewSamplesHost& view, std::span<float> visibility, std::span<uint32_t> mask) {
    masks_.bind(view, visibility, mask);
  }
  bool begin(uint32_t pixel, uint32_t* mask) const override;
  void write(uint32_t pixel, const uint32_t* mask) const override;
  // A pixel that the light does not reach.
  void write_blocked(uint32_t pixel) const { masks_.write_whole(pixel, true); }
  uint64_t bytes() const { return masks_.bytes(); }

 private:
  // Words of the kernel's mask that hold a word of HostMasks: its low and its high half.
  std::size_t low(std::size_t word) const { return masks_.grid() ? word : 2 * word; }
  std::size_t high(std::size_t word) const { return masks_.grid() ? most_rows + word : 2 * word + 1; }

  HostMasks masks_;
  bool halves_ = false;   // whether there are high halves
  std::size_t used_ = 1;  // of each half's words, in whole vectors
  uint32_t unowned_[most_words] = {};
};

}  // namespace penumbra::gears::cpu
