// Relative depth complexity of the light's samples from crossings and events, and which samples have the
// least: per instruction set. Counters are as wide as the sum of all weights needs, so none can wrap.
#if defined(PENUMBRA_DEPTH_COMPLEXITY_COUNTERS) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_DEPTH_COMPLEXITY_COUNTERS
#undef PENUMBRA_DEPTH_COMPLEXITY_COUNTERS
#else
#define PENUMBRA_DEPTH_COMPLEXITY_COUNTERS
#endif
#include <cstring>
#include <limits>

#include "techniques/depth_complexity_sampling/crossings-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::depth_complexity::HWY_NAMESPACE {

// Counters of a grid lie row by row, a row's in `pitch` places; one more row takes what falls below the last
// one.

// Adds each crossing's weight at the first row below it, in each column it covers: a running sum down the
// rows then gives the counters.
template <class T>
HWY_INLINE void scatter(const Crossings& in, std::size_t pitch, T* counters) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const std::size_t lanes = hn::Lanes(d);
  constexpr float many_columns = 4;
  alignas(64) int32_t place[block_edges];
  const auto row_start = [&](Vector x, Vector x0, Vector y0, Vector slope, Vector lo, Vector hi) HWY_ATTR {
    const Vector y = hn::Add(y0, hn::Mul(hn::Sub(x, x0), slope));
    const Vector row = hn::Ceil(hn::Min(hn::Max(y, lo), hi));
    hn::Store(hn::ConvertTo(di, hn::Add(hn::Mul(row, set(static_cast<float>(pitch))), x)), di, place);
  };
  for (std::size_t o = 0; o < in.count; o += lanes) {
    const auto load = [&](CrossingField f) HWY_ATTR { return hn::LoadU(d, in.v[f].data() + o); };
    const float* weights = in.v[cross_weight].data() + o;
    Vector x = load(cross_first);
    const Vector last = load(cross_last);
    Mask active = hn::Lt(x, last);
    if (o + lanes > in.count) active = hn::And(active, hn::FirstN(d, in.count - o));
    const Mask wide = hn::And(active, hn::Ge(hn::Sub(last, x), set(many_columns)));
    if (!hn::AllFalse(d, wide)) {
      active = hn::AndNot(wide, active);
      for (uint32_t bits = bits_of(wide); bits; bits &= bits - 1) {
        const std::size_t i = o + static_cast<std::size_t>(__builtin_ctz(bits));
        const T w = static_cast<T>(in.v[cross_weight][i]);
        const auto all = [&](CrossingField f) HWY_ATTR { return set(in.v[f][i]); };
        for (float c = in.v[cross_first][i]; c < in.v[cross_last][i]; c += static_cast<float>(lanes)) {
          row_start(hn::Iota(d, c), all(cross_x0), all(cross_y0), all(cross_slope), all(cross_lo),
                    all(cross_hi));
          const auto n = std::min(lanes, static_cast<std::size_t>(in.v[cross_last][i] - c));
          for (std::size_t l = 0; l < n; ++l) counters[place[l]] = static_cast<T>(counters[place[l]] + w);
        }
      }
    }
    while (!hn::AllFalse(d, active)) {
      row_start(x, load(cross_x0), load(cross_y0), load(cross_slope), load(cross_lo), load(cross_hi));
      for (uint32_t bits = bits_of(active); bits; bits &= bits - 1) {
        const auto l = static_cast<std::size_t>(__builtin_ctz(bits));
        counters[place[l]] = static_cast<T>(counters[place[l]] + static_cast<T>(weights[l]));
      }
      x = hn::Add(x, set(1.0F));
      active = hn::And(active, hn::Lt(x, last));
    }
  }
}

template <class T>
HWY_INLINE T least_of(const T* values, std::size_t count) {  // count: a multiple of 16
  const hn::CappedTag<T, 16 / sizeof(T)> d;
  const std::size_t lanes = hn::Lanes(d);
  auto least = hn::Load(d, values);
  for (std::size_t i = lanes; i < count; i += lanes) least = hn::Min(least, hn::Load(d, values + i));
  alignas(16) T last[16];
  hn::Store(least, d, last);
  return *std::min_element(last, last + lanes);
}

// The rows' candidates.
template <std::size_t pitch, class T>
HWY_NOINLINE void grid_candidates(const Crossings& in, int columns, int rows, T* counters, uint64_t* words) {
  const std::size_t places = pitch * static_cast<std::size_t>(rows);
  const hn::CappedTag<T, pitch> d;
  const std::size_t lanes = hn::Lanes(d);
  std::memset(counters, 0, (places + pitch) * sizeof(T));
  scatter(in, pitch, counters);
  // What events add to whole columns. Places past the last column are never the least.
  alignas(64) T top[pitch], least[pitch];
  std::fill(top, top + pitch, static_cast<T>(0));
  for (std::size_t e = 0; e < in.events; ++e) {
    const float x = in.v[event_x][e];
    if (x < static_cast<float>(columns)) {
      T& t = top[static_cast<std::size_t>(x)];
      t = static_cast<T>(t + static_cast<T>(in.v[event_weight][e]));
    }
  }
  if (in.events)
    for (std::size_t c = 1; c < static_cast<std::size_t>(columns); ++c)
      top[c] = static_cast<T>(top[c] + top[c - 1]);
  std::fill(top + columns, top + pitch, std::numeric_limits<T>::max());
  for (std::size_t c = 0; c < pitch; c += lanes) {
    auto sum = hn::Load(d, top + c), low = hn::Set(d, std::numeric_limits<T>::max());
    for (std::size_t i = c; i < places; i += pitch) {
      sum = hn::Add(sum, hn::Load(d, counters + i));
      hn::Store(sum, d, counters + i);
      low = hn::Min(low, sum);
    }
    hn::Store(low, d, least + c);
  }
  const auto minimum = hn::Set(d, least_of(least, pitch));
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) {
    uint64_t row = 0;
    for (std::size_t c = 0; c < pitch; c += lanes) {
      alignas(8) uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, hn::Eq(hn::Load(d, counters + r * pitch + c), minimum), bytes);
      uint64_t bits = 0;
      std::memcpy(&bits, bytes, 8);
      row |= bits << c;
    }
    words[r] = row;
  }
}

// The candidates of a set: each crossing against each sample.
HWY_NOINLINE void set_candidates(const Crossings& in, const float* xs, const float* ys, std::size_t samples,
                                 int32_t* counters, uint64_t* words) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const std::size_t lanes = hn::Lanes(d), padded = (samples + block_edges - 1) / block_edges * block_edges;
  std::memset(counters, 0, padded * sizeof(int32_t));
  const auto add = [&](std::size_t s, Mask where, float w) HWY_ATTR {
    auto sum = hn::Load(di, counters + s);
    const auto step = hn::Set(di, static_cast<int32_t>(w));
    hn::Store(hn::Add(sum, hn::IfThenElseZero(hn::RebindMask(di, where), step)), di, counters + s);
  };
  for (std::size_t e = 0; e < in.count; ++e) {
    const auto all = [&](CrossingField f) HWY_ATTR { return set(in.v[f][e]); };
    const Vector x0 = all(cross_x0), y0 = all(cross_y0), slope = all(cross_slope), lo = all(cross_lo),
                 hi = all(cross_hi), first = all(cross_first), last = all(cross_last);
    for (std::size_t s = 0; s < padded; s += lanes) {
      const Vector x = hn::LoadU(d, xs + s);
      const Mask covered = hn::And(hn::Le(first, x), hn::Lt(x, last));
      const Vector y = hn::Min(hn::Max(hn::Add(y0, hn::Mul(hn::Sub(x, x0), slope)), lo), hi);
      add(s, hn::And(covered, hn::Ge(hn::LoadU(d, ys + s), y)), in.v[cross_weight][e]);
    }
  }
  for (std::size_t e = 0; e < in.events; ++e)
    for (std::size_t s = 0; s < padded; s += lanes)
      add(s, hn::Ge(hn::LoadU(d, xs + s), set(in.v[event_x][e])), in.v[event_weight][e]);
  // Padding repeats the last sample.
  const int32_t minimum = least_of(counters, padded);
  for (std::size_t w = 0; w < (samples + 63) / 64; ++w) {
    words[w] = 0;
    for (std::size_t s = w * 64; s < std::min(samples, w * 64 + 64); ++s)
      words[w] |= static_cast<uint64_t>(counters[s] == minimum) << (s % 64);
  }
}

}  // namespace penumbra::depth_complexity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
