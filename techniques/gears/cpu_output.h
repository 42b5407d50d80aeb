// backend: cpu. Horizon before, visibility and mask after a view sample's triangles.
#pragma once
#include <span>

#include "samples/light_samples.h"
#include "samples/view_samples.h"
#include "techniques/common/mask_layout.h"
#include "techniques/gears/cpu_kernel.h"

namespace penumbra::gears::cpu {

class MaskOutput final : public Masks {
 public:
  void set_light(const Light& light, const LightSamples& samples, const MaskLayout& layout);
  // For one frame.
  void bind(const ViewSamplesHost& view, std::span<float> visibility, std::span<uint32_t> mask);

  bool begin(uint32_t pixel, uint32_t* mask) const override;
  void write(uint32_t pixel, const uint32_t* mask) const override;
  // A pixel that the light does not reach.
  void write_blocked(uint32_t pixel) const;
  uint64_t bytes() const { return samples_.points.capacity() * (sizeof(Vec4f) + sizeof(float)); }

 private:
  bool shines_on(Vec3f position) const;
  uint64_t row(const uint32_t* mask, std::size_t r) const;
  void write_packed(const uint32_t* mask, uint32_t* out) const;
  void write_unpacked(const uint32_t* mask, uint32_t* out) const;

  Light light_;
  LightSamples samples_;
  MaskLayout layout_;
  Box bounds_;
  float cone_cosine_ = -1;
  std::size_t rows_ = 1, columns_ = 1, words_ = 1, used_ = 1;
  bool packed_ = false;
  uint32_t unowned_[most_words] = {};
  ViewSamplesHost view_;
  std::span<float> visibility_;
  std::span<uint32_t> mask_;
};

}  // namespace penumbra::gears::cpu
