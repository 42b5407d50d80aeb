#include "techniques/depth_complexity_sampling/judge.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace penumbra::depth_complexity {
namespace {

// Inline, where std::popcount is a call into the compiler's library on a baseline x86-64.
std::size_t bit_count(uint64_t v) {
  v -= v >> 1 & 0x5555555555555555U;
  v = (v & 0x3333333333333333U) + (v >> 2 & 0x3333333333333333U);
  return ((v + (v >> 4)) & 0x0f0f0f0f0f0f0f0fU) * 0x0101010101010101U >> 56;
}

}  // namespace

void RayJudge::assign(const Light& light, const LightSamples& samples, const LightSpace& space) {
  light_ = light;
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
  grid_ = space.grid;
  columns_ = grid_ ? static_cast<std::size_t>(space.columns) : 64;
  used_words_ = grid_ ? static_cast<std::size_t>(space.rows) : (samples_ + 63) / 64;
  mask_words_ = static_cast<std::size_t>(samples.mask_words());
  packed_ = samples_ % 64 == 0 && 64 % columns_ == 0;
  all_.assign(used_words_, columns_ == 64 ? ~uint64_t{0} : (uint64_t{1} << columns_) - 1);
  if (const std::size_t rest = samples_ % columns_) all_.back() = (uint64_t{1} << rest) - 1;
  middle_ = choose_middle(all_.data());
}

void RayJudge::bind(const EmbreeHierarchy& hierarchy, const ViewSamplesHost& view,
                    std::span<float> visibility, std::span<uint32_t> mask) {
  hierarchy_ = &hierarchy, view_ = &view, visibility_ = visibility, mask_ = mask;
}

uint64_t RayJudge::bytes() const {
  return (x_.capacity() + y_.capacity() + z_.capacity() + weights_.capacity()) * sizeof(float);
}

// A rectangle shines from its front only and a spot light inside its cone only.
bool RayJudge::shines_on(Vec3f position) const {
  const Vec3f from_light = position - light_.center;
  if (light_.kind == LightKind::rectangle || light_.kind == LightKind::textured_rectangle)
    return dot(light_.direction, from_light) > 0;
  if (light_.kind == LightKind::spot)
    return dot(light_.direction, from_light) >= cone_cosine_ * length(from_light);
  return true;
}

RayJudge::Horizon RayJudge::horizon(std::size_t pixel) const {
  const Vec3f p = view_->position[pixel].xyz(), n = view_->geometric_normal[pixel].xyz();
  if (!shines_on(p)) return Horizon::below;
  float least = 0, most = 0;
  const auto size = [](const Vec3f& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  for (int i = 0; i < 3; ++i) {
    const float a = n[i] * (bounds_.lo[i] - p[i]), b = n[i] * (bounds_.hi[i] - p[i]);
    least += std::min(a, b), most += std::max(a, b);
  }
  const float rounding = 1e-5F * (size(bounds_.lo) + size(bounds_.hi) + size(p));
  return least > rounding ? Horizon::above : most < -rounding ? Horizon::below : Horizon::across;
}

void RayJudge::write_whole(std::size_t pixel, bool blocked) const {
  uint32_t* mask = &mask_[pixel * mask_words_];
  std::fill_n(mask, mask_words_, blocked ? ~0U : 0U);
  if (blocked && samples_ % 32) mask[mask_words_ - 1] = (1U << samples_ % 32) - 1;
  visibility_[pixel] = blocked ? 0.0F : 1.0F;
}

std::size_t RayJudge::sample_at(std::size_t word, int bit) const {
  return word * columns_ + static_cast<std::size_t>(bit);
}

// The shared horizon rule: a light sample with dot(Ng, L - P) <= 0 is blocked, P being the position.
void RayJudge::keep_above_horizon(std::size_t pixel, uint64_t* words) const {
  const Vec3f p = view_->position[pixel].xyz(), n = view_->geometric_normal[pixel].xyz();
  for (std::size_t w = 0; w < used_words_; ++w) {
    uint64_t above = 0;
    for (std::size_t i = w * columns_, bit = 0; bit < columns_ && i < samples_; ++i, ++bit)
      above |= static_cast<uint64_t>(n.x * (x_[i] - p.x) + n.y * (y_[i] - p.y) + n.z * (z_[i] - p.z) > 0)
               << bit;
    words[w] &= above;
  }
}

// A candidate, if it can be one of a grid whose four neighbours (or the light's border) are candidates too:
// far from where rounding decides.
RayJudge::Choice RayJudge::choose(const uint64_t* words) const {
  const std::size_t n = used_words_;
  if (grid_) {
    const uint64_t right_border = uint64_t{1} << (columns_ - 1);
    for (std::size_t r = 0; r < n; ++r) {
      const uint64_t w = words[r];
      const uint64_t inner = w & words[r > 0 ? r - 1 : r] & words[r + 1 < n ? r + 1 : r] & (w << 1 | 1) &
                             (w >> 1 | (w & right_border));
      if (inner) return {sample_at(r, std::countr_zero(inner)), true};
    }
  }
  for (std::size_t w = 0; w < n; ++w)
    if (words[w]) return {sample_at(w, std::countr_zero(words[w])), false};
  return {samples_, false};
}

// Where no edge parts the samples, any will do.
RayJudge::Choice RayJudge::choose_middle(const uint64_t* words) const {
  const std::size_t word = used_words_ / 2, bit = grid_ ? columns_ / 2 : 0;
  if (words[word] >> bit & 1) return {sample_at(word, static_cast<int>(bit)), true};
  Choice c = choose(words);
  c.inner = true;
  return c;
}

bool RayJudge::blocked(std::size_t pixel, std::size_t sample) const {
  const Vec3f o = view_->origin[pixel].xyz();
  Segments s{};
  s.x[0] = o.x, s.y[0] = o.y, s.z[0] = o.z;
  s.to_x[0] = x_[sample], s.to_y[0] = y_[sample], s.to_z[0] = z_[sample];
  return blocked_segments(*hierarchy_, s, 1) != 0;
}

// Where the candidate stands at a border of their region, another one is asked too; should the two disagree,
// a tie is involved, and each candidate is asked.
bool RayJudge::verify(std::size_t pixel, Choice first, bool is_blocked, uint64_t* words,
                      Scratch& scratch) const {
  std::size_t last = samples_;
  for (std::size_t w = used_words_; w-- > 0 && last == samples_;)
    if (words[w]) last = sample_at(w, 63 - std::countl_zero(words[w]));
  if (last == first.sample) return is_blocked;
  ++scratch.counts.extra_rays;
  if (blocked(pixel, last) == is_blocked) return is_blocked;
  for (std::size_t w = 0; w < used_words_; ++w)
    for (uint64_t bits = words[w]; bits; bits &= bits - 1) {
      ++scratch.counts.extra_rays;
      if (blocked(pixel, sample_at(w, std::countr_zero(bits)))) words[w] &= ~(bits & (~bits + 1));
    }
  return false;
}

// Rows that fill 64 bits together: those of the usual grids.
std::size_t RayJudge::write_packed(const uint64_t* visible, uint32_t* mask) const {
  const std::size_t rows = 64 / columns_;
  std::size_t seen = 0;
  for (std::size_t w = 0; w < used_words_; w += rows, mask += 2) {
    uint64_t bits = 0;
    for (std::size_t r = 0; r < rows; ++r) bits |= visible[w + r] << (r * columns_);
    seen += bit_count(bits);
    mask[0] = static_cast<uint32_t>(~bits), mask[1] = static_cast<uint32_t>(~bits >> 32);
  }
  return seen;
}

std::size_t RayJudge::write_unpacked(const uint64_t* visible, uint32_t* mask) const {
  std::size_t seen = 0, word = 0;
  uint64_t pending = 0;
  std::size_t pending_bits = 0, left = samples_;
  for (std::size_t w = 0; w < used_words_; ++w) {
    const std::size_t bits = std::min(columns_, left);
    const uint64_t blocked_bits = ~visible[w] & all_[w];
    seen += bit_count(visible[w]);
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
  return seen;
}

// `visible`: bits of seen samples, as the candidates lie.
void RayJudge::write(std::size_t pixel, const uint64_t* visible) const {
  uint32_t* mask = &mask_[pixel * mask_words_];
  const std::size_t seen = packed_ ? write_packed(visible, mask) : write_unpacked(visible, mask);
  if (uniform_) {
    visibility_[pixel] = static_cast<float>(seen) / static_cast<float>(samples_);
    return;
  }
  double sum = 0;
  for (std::size_t w = 0; w < used_words_; ++w)
    for (uint64_t bits = visible[w]; bits; bits &= bits - 1)
      sum += static_cast<double>(weights_[sample_at(w, std::countr_zero(bits))]);
  visibility_[pixel] = static_cast<float>(std::min(sum, 1.0));
}

// Each light sample asked on its own: where P lies before a rectangle's plane and P' does not, so that
// nothing can be projected onto it.
std::size_t RayJudge::trace_each(std::size_t pixel) const {
  uint64_t words[most_words];
  std::copy(all_.begin(), all_.end(), words);
  keep_above_horizon(pixel, words);
  std::size_t rays = 0;
  for (std::size_t w = 0; w < used_words_; ++w)
    for (uint64_t bits = words[w]; bits; bits &= bits - 1, ++rays)
      if (blocked(pixel, sample_at(w, std::countr_zero(bits)))) words[w] &= ~(bits & (~bits + 1));
  write(pixel, words);
  return rays;
}

void RayJudge::judge(const ViewPoint* points, std::size_t count, Scratch& scratch) const {
  Segments segments{};
  Choice choices[small_group];
  bool whole[small_group];  // all samples, or none
  uint32_t wanted = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = points[i].pixel;
    uint64_t* words = scratch.candidates.words[i];
    const bool parted = scratch.candidates.parted[i];
    whole[i] = !parted && !points[i].across;
    if (!parted && !whole[i]) std::copy(all_.begin(), all_.end(), words);
    if (points[i].across) keep_above_horizon(pixel, words);
    choices[i] = parted ? choose(words) : whole[i] ? middle_ : choose_middle(words);
    if (choices[i].sample == samples_) continue;
    wanted |= 1U << i;
    const Vec3f o = view_->origin[pixel].xyz();
    const std::size_t s = choices[i].sample;
    segments.x[i] = o.x, segments.y[i] = o.y, segments.z[i] = o.z;
    segments.to_x[i] = x_[s], segments.to_y[i] = y_[s], segments.to_z[i] = z_[s];
  }
  const uint32_t blocked_bits = wanted ? blocked_segments(*hierarchy_, segments, wanted) : 0;
  scratch.counts.rays += bit_count(wanted);
  for (std::size_t i = 0; i < count; ++i) {
    uint64_t* words = scratch.candidates.words[i];
    bool is_blocked = (wanted >> i & 1) == 0 || (blocked_bits >> i & 1) != 0;
    if (wanted >> i & 1 && !choices[i].inner)
      is_blocked = verify(points[i].pixel, choices[i], is_blocked, words, scratch);
    is_blocked || whole[i] ? write_whole(points[i].pixel, is_blocked) : write(points[i].pixel, words);
  }
}

}  // namespace penumbra::depth_complexity
