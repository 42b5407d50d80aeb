#include "techniques/depth_complexity_sampling/judge.h"

#include <algorithm>
#include <bit>

namespace penumbra::depth_complexity {

void RayJudge::assign(const Light& light, const LightSamples& samples, const LightSpace& space) {
  masks_.assign(light, samples, {space.grid, false, space.columns, space.rows});
  middle_ = choose_middle(masks_.all().data());
}

void RayJudge::bind(const EmbreeHierarchy& hierarchy, const ViewSamplesHost& view,
                    std::span<float> visibility, std::span<uint32_t> mask) {
  hierarchy_ = &hierarchy;
  masks_.bind(view, visibility, mask);
}

// A candidate, if it can be one of a grid whose four neighbours (or the light's border) are candidates too:
// far from where rounding decides.
RayJudge::Choice RayJudge::choose(const uint64_t* words) const {
  const std::size_t n = masks_.words();
  if (masks_.grid()) {
    const uint64_t right_border = uint64_t{1} << (masks_.columns() - 1);
    for (std::size_t r = 0; r < n; ++r) {
      const uint64_t w = words[r];
      const uint64_t inner = w & words[r > 0 ? r - 1 : r] & words[r + 1 < n ? r + 1 : r] & (w << 1 | 1) &
                             (w >> 1 | (w & right_border));
      if (inner) return {masks_.sample_at(r, std::countr_zero(inner)), true};
    }
  }
  for (std::size_t w = 0; w < n; ++w)
    if (words[w]) return {masks_.sample_at(w, std::countr_zero(words[w])), false};
  return {masks_.samples(), false};
}

// Where no edge parts the samples, any will do.
RayJudge::Choice RayJudge::choose_middle(const uint64_t* words) const {
  const std::size_t word = masks_.words() / 2, bit = masks_.grid() ? masks_.columns() / 2 : 0;
  if (words[word] >> bit & 1) return {masks_.sample_at(word, static_cast<int>(bit)), true};
  Choice c = choose(words);
  c.inner = true;
  return c;
}

bool RayJudge::blocked(std::size_t pixel, std::size_t sample) const {
  const Vec3f o = masks_.view().origin[pixel].xyz(), l = masks_.sample(sample);
  Segments s{};
  s.x[0] = o.x, s.y[0] = o.y, s.z[0] = o.z;
  s.to_x[0] = l.x, s.to_y[0] = l.y, s.to_z[0] = l.z;
  return blocked_segments(*hierarchy_, s, 1) != 0;
}

// Where the candidate stands at a border of their region, another one is asked too; should the two disagree,
// a tie is involved, and each candidate is asked.
bool RayJudge::verify(std::size_t pixel, Choice first, bool is_blocked, uint64_t* words,
                      Scratch& scratch) const {
  std::size_t last = masks_.samples();
  for (std::size_t w = masks_.words(); w-- > 0 && last == masks_.samples();)
    if (words[w]) last = masks_.sample_at(w, 63 - std::countl_zero(words[w]));
  if (last == first.sample) return is_blocked;
  ++scratch.counts.extra_rays;
  if (blocked(pixel, last) == is_blocked) return is_blocked;
  for (std::size_t w = 0; w < masks_.words(); ++w)
    for (uint64_t bits = words[w]; bits; bits &= bits - 1) {
      ++scratch.counts.extra_rays;
      if (blocked(pixel, masks_.sample_at(w, std::countr_zero(bits)))) words[w] &= ~(bits & (~bits + 1));
    }
  return false;
}

// Each light sample asked on its own: where P lies before a rectangle's plane and P' does not, so that
// nothing can be projected onto it.
std::size_t RayJudge::trace_each(std::size_t pixel) const {
  uint64_t words[most_words];
  std::copy(masks_.all().begin(), masks_.all().end(), words);
  masks_.keep_above_horizon(pixel, words);
  std::size_t rays = 0;
  for (std::size_t w = 0; w < masks_.words(); ++w)
    for (uint64_t bits = words[w]; bits; bits &= bits - 1, ++rays)
      if (blocked(pixel, masks_.sample_at(w, std::countr_zero(bits)))) words[w] &= ~(bits & (~bits + 1));
  masks_.write(pixel, words);
  return rays;
}

void RayJudge::judge(const ViewPoint* points, std::size_t count, Scratch& scratch) const {
  Segments segments{};
  Choice choices[small_group];
  bool whole[small_group];  // all samples, or none
  uint32_t wanted = 0;
  uint64_t rays = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = points[i].pixel;
    uint64_t* words = scratch.candidates.words[i];
    const bool parted = scratch.candidates.parted[i];
    whole[i] = !parted && !points[i].across;
    if (!parted && !whole[i]) std::copy(masks_.all().begin(), masks_.all().end(), words);
    if (points[i].across) masks_.keep_above_horizon(pixel, words);
    choices[i] = parted ? choose(words) : whole[i] ? middle_ : choose_middle(words);
    if (choices[i].sample == masks_.samples()) continue;
    wanted |= 1U << i, ++rays;
    const Vec3f o = masks_.view().origin[pixel].xyz(), l = masks_.sample(choices[i].sample);
    segments.x[i] = o.x, segments.y[i] = o.y, segments.z[i] = o.z;
    segments.to_x[i] = l.x, segments.to_y[i] = l.y, segments.to_z[i] = l.z;
  }
  const uint32_t blocked_bits = wanted ? blocked_segments(*hierarchy_, segments, wanted) : 0;
  scratch.counts.rays += rays;
  for (std::size_t i = 0; i < count; ++i) {
    uint64_t* words = scratch.candidates.words[i];
    bool is_blocked = (wanted >> i & 1) == 0 || (blocked_bits >> i & 1) != 0;
    if (wanted >> i & 1 && !choices[i].inner)
      is_blocked = verify(points[i].pixel, choices[i], is_blocked, words, scratch);
    is_blocked || whole[i] ? masks_.write_whole(points[i].pixel, is_blocked)
                           : masks_.write(points[i].pixel, words);
  }
}

}  // namespace penumbra::depth_complexity
