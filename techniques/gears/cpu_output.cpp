#include "techniques/gears/cpu_output.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace penumbra::gears::cpu {
namespace {

// Inline, where std::popcount is a call into the compiler's library on a baseline x86-64.
uint32_t bit_count(uint64_t v) {
  v -= v >> 1 & 0x5555555555555555U;
  v = (v & 0x3333333333333333U) + (v >> 2 & 0x3333333333333333U);
  return static_cast<uint32_t>(((v + (v >> 4)) & 0x0f0f0f0f0f0f0f0fU) * 0x0101010101010101U >> 56);
}

}  // namespace

void MaskOutput::set_light(const Light& light, const LightSamples& samples, const MaskLayout& layout) {
  light_ = light, samples_ = samples, layout_ = layout;
  bounds_ = {};
  for (const Vec4f& p : samples.points) bounds_.extend(p.xyz());
  cone_cosine_ =
      static_cast<float>(std::cos(static_cast<double>(light.cone_degrees) * std::numbers::pi / 180));
  // A set is rows of 32.
  const auto count = static_cast<std::size_t>(samples.count());
  columns_ = layout.grid ? static_cast<std::size_t>(layout.columns) : 32;
  rows_ = layout.grid ? static_cast<std::size_t>(layout.rows) : (count + 31) / 32;
  words_ = static_cast<std::size_t>(samples.mask_words());
  used_ = (rows_ + block_size - 1) / block_size * block_size;  // whole vectors
  packed_ = columns_ <= 32 && 32 % columns_ == 0 && count % 32 == 0;
  std::fill(std::begin(unowned_), std::end(unowned_), ~0U);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t r = i / columns_, c = i % columns_;
    unowned_[(layout.grid ? c / 32 * most_rows : 0) + r] &= ~(1U << c % 32);
  }
}

void MaskOutput::bind(const ViewSamplesHost& view, std::span<float> visibility, std::span<uint32_t> mask) {
  view_ = view, visibility_ = visibility, mask_ = mask;
}

// A rectangle shines from its front only and a spot light inside its cone only.
bool MaskOutput::shines_on(Vec3f position) const {
  const Vec3f from_light = position - light_.center;
  if (light_.kind == LightKind::rectangle || light_.kind == LightKind::textured_rectangle)
    return dot(light_.direction, from_light) > 0;
  if (light_.kind == LightKind::spot)
    return dot(light_.direction, from_light) >= cone_cosine_ * length(from_light);
  return true;
}

// The shared horizon rule: a light sample with dot(Ng, L - P) <= 0 is blocked, P being the position.
bool MaskOutput::begin(uint32_t pixel, uint32_t* mask) const {
  std::copy_n(unowned_, used_, mask);
  if (columns_ > 32) std::copy_n(unowned_ + most_rows, used_, mask + most_rows);
  const Vec3f n = view_.geometric_normal[pixel].xyz();
  Vec3f p = view_.position[pixel].xyz();
  if (!shines_on(p)) {
    std::fill(mask, mask + most_words, ~0U);
    return false;
  }
  if (layout_.infinite) p = {};
  // Beyond any rounding: all above?
  float least_ = 0;
  const auto size = [](const Vec3f& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  for (int i = 0; i < 3; ++i)
    least_ += std::min(n[i] * (bounds_.lo[i] - p[i]), n[i] * (bounds_.hi[i] - p[i]));
  if (least_ > 1e-5F * (size(bounds_.lo) + size(bounds_.hi) + size(p))) return true;
  uint32_t open = 0;
  for (std::size_t i = 0; i < samples_.points.size(); ++i) {
    const std::size_t r = i / columns_, c = i % columns_;
    const bool above = dot(n, samples_.points[i].xyz() - p) > 0;
    if (!above) mask[(layout_.grid ? c / 32 * most_rows : 0) + r] |= 1U << c % 32;
    open |= above ? 1U : 0U;
  }
  return open != 0;
}

uint64_t MaskOutput::row(const uint32_t* mask, std::size_t r) const {
  const uint64_t high =
      columns_ > 32 ? static_cast<uint64_t>(mask[most_rows + r] & ~unowned_[most_rows + r]) : 0;
  return (mask[r] & ~unowned_[r]) | high << 32;
}

// Rows that fill 32 bits together: those of the usual grids, and sets.
void MaskOutput::write_packed(const uint32_t* mask, uint32_t* out) const {
  const std::size_t rows = 32 / columns_;
  const uint32_t own = ~0U >> (32 - columns_);
  for (std::size_t w = 0; w < words_; ++w, mask += rows) {
    uint32_t bits = 0;
    for (std::size_t r = 0; r < rows; ++r) bits |= (mask[r] & own) << (r * columns_);
    out[w] = bits;
  }
}

void MaskOutput::write_unpacked(const uint32_t* mask, uint32_t* out) const {
  std::size_t word = 0, pending_bits = 0;
  uint64_t pending = 0;
  for (std::size_t r = 0; r < rows_; ++r) {
    const uint64_t bits = row(mask, r);
    pending |= bits << pending_bits;
    uint64_t over = pending_bits != 0 ? bits >> 1 >> (63 - pending_bits) : 0;
    pending_bits += columns_;
    while (pending_bits >= 32 && word < words_) {
      out[word++] = static_cast<uint32_t>(pending);
      pending = pending >> 32 | over << 32;
      over >>= 32;
      pending_bits -= 32;
    }
  }
  if (word < words_) out[word] = static_cast<uint32_t>(pending);
}

void MaskOutput::write(uint32_t pixel, const uint32_t* mask) const {
  uint32_t* out = &mask_[pixel * words_];
  packed_ ? write_packed(mask, out) : write_unpacked(mask, out);
  if (samples_.uniform_weights) {
    uint32_t blocked = 0;
    std::size_t w = 0;
    for (; w + 1 < words_; w += 2) blocked += bit_count(out[w] | static_cast<uint64_t>(out[w + 1]) << 32);
    if (w < words_) blocked += bit_count(out[w]);
    const auto all = static_cast<uint32_t>(samples_.points.size());
    visibility_[pixel] = static_cast<float>(all - blocked) / static_cast<float>(all);
    return;
  }
  double sum = 0;
  for (std::size_t i = 0; i < samples_.points.size(); ++i)
    if ((out[i / 32] >> i % 32 & 1) == 0) sum += static_cast<double>(samples_.weights[i]);
  visibility_[pixel] = static_cast<float>(std::min(sum, 1.0));
}

void MaskOutput::write_blocked(uint32_t pixel) const {
  uint32_t* out = &mask_[pixel * words_];
  std::fill_n(out, words_, ~0U);
  if (samples_.points.size() % 32) out[words_ - 1] = (1U << samples_.points.size() % 32) - 1;
  visibility_[pixel] = 0;
}

}  // namespace penumbra::gears::cpu
