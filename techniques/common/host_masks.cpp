#include "techniques/common/host_masks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace penumbra {
namespace {

// Inline, where std::popcount is a call into the compiler's library on a baseline x86-64.
std::size_t bit_count(uint64_t v) {
  v -= v >> 1 & 0x5555555555555555U;
  v = (v & 0x3333333333333333U) + (v >> 2 & 0x3333333333333333U);
  return ((v + (v >> 4)) & 0x0f0f0f0f0f0f0f0fU) * 0x0101010101010101U >> 56;
}

}  // namespace

void HostMasks::assign(const Light& light, const LightSamples& samples, const Layout& layout) {
  light_ = light, layout_ = layout;
  samples_ = samples.points.size();
  x_.clear(), y_.clear(), z_.clear();
  bounds_ = {};
  for (const Vec4f& p : samples.points) {
    x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
    bounds_.extend(p.xyz());
  }
  weights_ = samples.weights;
  uniform_ = samples.uniform_weights;
  cone_cosine_ =
      static_cast<float>(std::cos(static_cast<double>(light.cone_degrees) * std::numbers::pi / 180));
  columns_ = layout.grid ? static_cast<std::size_t>(layout.columns) : 64;
  mask_words_ = static_cast<std::size_t>(samples.mask_words());
  packed_ = samples_ % 64 == 0 && 64 % columns_ == 0;
  const std::size_t words = layout.grid ? static_cast<std::size_t>(layout.rows) : (samples_ + 63) / 64;
  all_.assign(words, columns_ == 64 ? ~uint64_t{0} : (uint64_t{1} << columns_) - 1);
  if (const std::size_t rest = samples_ % columns_) all_.back() = (uint64_t{1} << rest) - 1;
}

void HostMasks::bind(const ViewSamplesHost& view, std::span<float> visibility, std::span<uint32_t> mask) {
  view_ = view, visibility_ = visibility, mask_ = mask;
}

uint64_t HostMasks::bytes() const {
  return (x_.capacity() + y_.capacity() + z_.capacity() + weights_.capacity()) * sizeof(float) +
         all_.capacity() * sizeof(uint64_t);
}

bool HostMasks::shines_on(Vec3f position) const {
  const Vec3f from_light = position - light_.center;
  if (light_.kind == LightKind::rectangle || light_.kind == LightKind::textured_rectangle)
    return dot(light_.direction, from_light) > 0;
  if (light_.kind == LightKind::spot)
    return dot(light_.direction, from_light) >= cone_cosine_ * length(from_light);
  return true;
}

// Bounds that of a height above the horizon, with room to spare.
float HostMasks::rounding_at(Vec3f p) const {
  const auto size = [](const Vec3f& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  return 1e-5F * (size(bounds_.lo) + size(bounds_.hi) + size(p));
}

HostMasks::Horizon HostMasks::horizon(std::size_t pixel) const {
  Vec3f p = view_.position[pixel].xyz();
  const Vec3f n = view_.geometric_normal[pixel].xyz();
  if (!shines_on(p)) return Horizon::below;
  if (layout_.infinite) p = {};
  float least = 0, most = 0;
  for (int i = 0; i < 3; ++i) {
    const float a = n[i] * (bounds_.lo[i] - p[i]), b = n[i] * (bounds_.hi[i] - p[i]);
    least += std::min(a, b), most += std::max(a, b);
  }
  const float rounding = rounding_at(p);
  return least > rounding ? Horizon::above : most < -rounding ? Horizon::below : Horizon::across;
}

void HostMasks::keep_above_horizon(std::size_t pixel, uint64_t* words) const {
  const Vec3f p = layout_.infinite ? Vec3f{} : view_.position[pixel].xyz(),
              n = view_.geometric_normal[pixel].xyz();
  const float rounding = rounding_at(p);
  const auto height = [&](std::size_t i) {
    return n.x * (x_[i] - p.x) + n.y * (y_[i] - p.y) + n.z * (z_[i] - p.z);
  };
  const auto first_bits = [](std::size_t count) {
    return count < 64 ? (uint64_t{1} << count) - 1 : ~uint64_t{0};
  };
  for (std::size_t w = 0; w < all_.size(); ++w) {
    const std::size_t first = w * columns_, count = std::min(samples_ - first, columns_);
    std::size_t from = 0, to = count;  // samples to look at
    uint64_t above = 0;
    // A row of a grid is straight: its ends tell for all of it, but for what lies within rounding of the
    // horizon.
    if (layout_.grid) {
      const float a = height(first), b = height(first + count - 1);
      if (std::min(a, b) > rounding) continue;
      if (std::max(a, b) < -rounding) {
        words[w] = 0;
        continue;
      }
      if (std::abs(a - b) > 8 * rounding) {
        const float steps = static_cast<float>(count - 1) / std::abs(a - b), middle = std::abs(a) * steps,
                    reach = 2 * rounding * steps;
        from = static_cast<std::size_t>(std::max(middle - reach, 0.0F));
        to = std::min(count, static_cast<std::size_t>(middle + reach) + 2);
        above = (a > 0 ? first_bits(from) : 0) | (b > 0 ? ~first_bits(to) : 0);
      }
    }
    for (std::size_t i = from; i < to; ++i) above |= static_cast<uint64_t>(height(first + i) > 0) << i;
    words[w] &= above;
  }
}

// Rows that fill 64 bits together: those of the usual grids, and sets.
std::size_t HostMasks::write_packed(const uint64_t* seen, uint32_t* mask) const {
  const std::size_t rows = 64 / columns_;
  std::size_t count = 0;
  for (std::size_t w = 0; w < all_.size(); w += rows, mask += 2) {
    uint64_t bits = 0;
    for (std::size_t r = 0; r < rows; ++r) bits |= seen[w + r] << (r * columns_);
    count += bit_count(bits);
    mask[0] = static_cast<uint32_t>(~bits), mask[1] = static_cast<uint32_t>(~bits >> 32);
  }
  return count;
}

std::size_t HostMasks::write_unpacked(const uint64_t* seen, uint32_t* mask) const {
  std::size_t count = 0, word = 0;
  uint64_t pending = 0;
  std::size_t pending_bits = 0, left = samples_;
  for (std::size_t w = 0; w < all_.size(); ++w) {
    const std::size_t bits = std::min(columns_, left);
    const uint64_t blocked_bits = ~seen[w] & all_[w];
    count += bit_count(seen[w]);
    left -= bits;
    pending |= blocked_bits << pending_bits;
    std::size_t have = pending_bits + bits;
    uint64_t over = have > 64 ? blocked_bits >> (64 - pending_bits) : 0;
    while (have >= 32) {
      mask[word++] = static_cast<uint32_t>(pending);
      pending = pending >> 32 | over << 32;
      over >>= 32;
      have -= 32;
    }
    pending_bits = have;
  }
  if (pending_bits) mask[word] = static_cast<uint32_t>(pending);
  return count;
}

void HostMasks::write(std::size_t pixel, const uint64_t* seen) const {
  uint32_t* mask = &mask_[pixel * mask_words_];
  const std::size_t count = packed_ ? write_packed(seen, mask) : write_unpacked(seen, mask);
  if (uniform_) {
    visibility_[pixel] = static_cast<float>(count) / static_cast<float>(samples_);
    return;
  }
  double sum = 0;
  for (std::size_t w = 0; w < all_.size(); ++w)
    for (uint64_t bits = seen[w]; bits; bits &= bits - 1)
      sum += static_cast<double>(weights_[sample_at(w, std::countr_zero(bits))]);
  visibility_[pixel] = static_cast<float>(std::min(sum, 1.0));
}

void HostMasks::write_whole(std::size_t pixel, bool blocked) const {
  uint32_t* mask = &mask_[pixel * mask_words_];
  std::fill_n(mask, mask_words_, blocked ? ~0U : 0U);
  if (blocked && samples_ % 32) mask[mask_words_ - 1] = (1U << samples_ % 32) - 1;
  visibility_[pixel] = blocked ? 0.0F : 1.0F;
}

}  // namespace penumbra
