#include "techniques/gears/cpu_output.h"

#include <algorithm>

namespace penumbra::gears::cpu {

void MaskOutput::set_light(const Light& light, const LightSamples& samples, const MaskLayout& layout) {
  masks_.assign(light, samples, {layout.grid, layout.infinite, layout.columns, layout.rows});
  halves_ = masks_.columns() > 32;
  const std::size_t words = masks_.words() * (masks_.grid() ? 1 : 2);
  used_ = (words + block_size - 1) / block_size * block_size;
  std::fill(std::begin(unowned_), std::end(unowned_), ~0U);
  for (std::size_t w = 0; w < masks_.words(); ++w) {
    unowned_[low(w)] = static_cast<uint32_t>(~masks_.all()[w]);
    if (halves_) unowned_[high(w)] = static_cast<uint32_t>(~masks_.all()[w] >> 32);
  }
}

bool MaskOutput::begin(uint32_t pixel, uint32_t* mask) const {
  const HostMasks::Horizon horizon = masks_.horizon(pixel);
  if (horizon == HostMasks::Horizon::below) {
    std::fill(mask, mask + most_words, ~0U);
    return false;
  }
  std::copy_n(unowned_, used_, mask);
  if (masks_.grid() && halves_) std::copy_n(unowned_ + most_rows, used_, mask + most_rows);
  if (horizon == HostMasks::Horizon::above) return true;
  uint64_t words[HostMasks::most_words], open = 0;
  std::copy(masks_.all().begin(), masks_.all().end(), words);
  masks_.keep_above_horizon(pixel, words);
  for (std::size_t w = 0; w < masks_.words(); ++w) {
    open |= words[w];
    mask[low(w)] = static_cast<uint32_t>(~words[w]);
    if (halves_) mask[high(w)] = static_cast<uint32_t>(~words[w] >> 32);
  }
  return open != 0;
}

void MaskOutput::write(uint32_t pixel, const uint32_t* mask) const {
  uint64_t seen[HostMasks::most_words];
  const uint64_t* all = masks_.all().data();
  const std::size_t words = masks_.words();
  if (halves_)
    for (std::size_t w = 0; w < words; ++w)
      seen[w] = ~(mask[low(w)] | static_cast<uint64_t>(mask[high(w)]) << 32) & all[w];
  else
    for (std::size_t w = 0; w < words; ++w) seen[w] = ~uint64_t{mask[w]} & all[w];
  masks_.write(pixel, seen);
}

}  // namespace penumbra::gears::cpu
