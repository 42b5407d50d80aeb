// Relative depth complexity of the light's samples from crossings and events, and which samples have the
// least: per instruction set. Counters are as wide as the sum of all weights needs, so none can wrap.
#if defined(PENUMBRA_DEPTH_COMPLEXITY_COUNTERS) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_DEPTH_COMPLEXITY_COUNTERS
#undef PENUMBRA_DEPTH_COMPLEXITY_COUNTERS
#else
#define PENUMBRA_DEPTH_COMPLEXITY_COUNTERS
#endif
#include <array>
#include <cstring>
#include <limits>

#include "techniques/depth_complexity_sampling/crossings-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::depth_complexity::HWY_NAMESPACE {

// Counters of a grid lie row by row, a row's in `pitch` places; one more row takes what falls below the last
// one.

// The first row below a crossing in each of some columns x.
struct RowStart {
  Vector x0, y0, slope, lo, hi;
  HWY_INLINE Vector at(Vector x) const {
    const Vector y = hn::Add(y0, hn::Mul(hn::Sub(x, x0), slope));
    return hn::Ceil(hn::Min(hn::Max(y, lo), hi));
  }
};

// Of a vector that may hold several rows: the row after a lane's.
template <std::size_t pitch, class T>
inline constexpr std::array<T, 64 / sizeof(T)> rows_after_lanes = [] {
  std::array<T, 64 / sizeof(T)> rows{};
  for (std::size_t l = 0; l < rows.size(); ++l) rows[l] = static_cast<T>(l / pitch + 1);
  return rows;
}();

// Crossings of many columns: every row learns by comparison whether it lies below, so that no counter is
// touched on its own. `sums` are counters proper, without the running sum. Several at once, so that a vector
// of counters is loaded and stored once for all of them.
template <std::size_t pitch, class T>
class WideCrossings {
 public:
  HWY_INLINE WideCrossings(std::size_t places, T* sums) : places_(places), sums_(sums) {}
  HWY_INLINE void add(const Crossings& in, std::size_t i) {
    const Floats d;
    const hn::Rebind<T, Floats> narrow;
    const hn::RebindToSigned<Floats> di;
    const auto all = [&](CrossingField f) HWY_ATTR { return set(in.v[f][i]); };
    const RowStart start{all(cross_x0), all(cross_y0), all(cross_slope), all(cross_lo), all(cross_hi)};
    const Vector first = all(cross_first), last = all(cross_last), never = set(127);
    // Per column its first row, as often as a vector has rows.
    T* const rows = rows_ + count_ * in_all;
    for (std::size_t c = 0; c < pitch; c += hn::Lanes(d)) {
      const Vector x = hn::Iota(d, static_cast<float>(c));
      const Mask covered = hn::And(hn::Le(first, x), hn::Lt(x, last));
      const auto row = hn::ConvertTo(di, hn::IfThenElse(covered, start.at(x), never));
      for (std::size_t k = c; k < in_all; k += pitch) {
        if constexpr (sizeof(T) == 4)
          hn::StoreU(row, di, rows + k);
        else
          hn::StoreU(hn::DemoteTo(narrow, row), narrow, rows + k);
      }
    }
    weights_[count_++] = static_cast<T>(in.v[cross_weight][i]);
    if (count_ == most) finish();
  }
  HWY_INLINE void finish() {
    const hn::CappedTag<T, 64 / sizeof(T)> dt;
    const std::size_t lanes = hn::Lanes(dt);
    if (count_ == 0) return;
    if (!any_) std::memset(sums_, 0, places_ * sizeof(T));
    any_ = true;
    const auto after_lane = hn::LoadU(dt, rows_after_lanes<pitch, T>.data());
    for (std::size_t at = 0; at < places_; at += lanes) {
      const auto after = hn::Add(after_lane, hn::Set(dt, static_cast<T>(at / pitch)));
      auto sum = hn::Load(dt, sums_ + at);
      const T* rows = rows_ + at % pitch;
      for (std::size_t i = 0; i < count_; ++i, rows += in_all)
        sum = hn::Add(sum, hn::IfThenElseZero(hn::Gt(after, hn::Load(dt, rows)), hn::Set(dt, weights_[i])));
      hn::Store(sum, dt, sums_ + at);
    }
    count_ = 0;
  }
  bool any() const { return any_; }

 private:
  static constexpr std::size_t most = 32, in_all = std::max<std::size_t>(pitch, 64 / sizeof(T));
  std::size_t places_, count_ = 0;
  T* sums_;
  bool any_ = false;
  alignas(64) T rows_[most * in_all];
  T weights_[most];
};

// Adds each crossing's weight at the first row below it, in each column it covers: a running sum down the
// rows then gives the counters. Crossings of many columns go to `sums` instead; returns whether there were
// any, without which `sums` holds nothing.
template <std::size_t pitch, class T>
HWY_INLINE bool scatter(const Crossings& in, std::size_t places, T* counters, T* sums) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const std::size_t lanes = hn::Lanes(d);
  // Where comparing all rows costs less than touching a counter per column.
  const std::size_t vectors = places / hn::Lanes(hn::CappedTag<T, 64 / sizeof(T)>());
  const Vector many_columns = set(static_cast<float>(3 + vectors / 2));
  alignas(64) int32_t place[block_edges], weights[block_edges];
  WideCrossings<pitch, T> wide_ones(places, sums);
  for (std::size_t o = 0; o < in.count; o += lanes) {
    const auto load = [&](CrossingField f) HWY_ATTR { return hn::LoadU(d, in.v[f].data() + o); };
    Vector x = load(cross_first);
    const Vector last = load(cross_last);
    Mask active = hn::Lt(x, last);
    if (o + lanes > in.count) active = hn::And(active, hn::FirstN(d, in.count - o));
    const Mask wide = hn::And(active, hn::Ge(hn::Sub(last, x), many_columns));
    if (!hn::AllFalse(d, wide)) {
      active = hn::AndNot(wide, active);
      for (uint32_t bits = bits_of(wide); bits; bits &= bits - 1)
        wide_ones.add(in, o + static_cast<std::size_t>(__builtin_ctz(bits)));
    }
    if (hn::AllFalse(d, active)) continue;
    const RowStart start{load(cross_x0), load(cross_y0), load(cross_slope), load(cross_lo), load(cross_hi)};
    hn::Store(hn::ConvertTo(di, load(cross_weight)), di, weights);
    do {
      const Vector at = hn::Add(hn::Mul(start.at(x), set(static_cast<float>(pitch))), x);
      hn::Store(hn::ConvertTo(di, at), di, place);
      for (uint32_t bits = bits_of(active); bits; bits &= bits - 1) {
        const auto l = static_cast<std::size_t>(__builtin_ctz(bits));
        counters[place[l]] = static_cast<T>(counters[place[l]] + static_cast<T>(weights[l]));
      }
      x = hn::Add(x, set(1.0F));
      active = hn::And(active, hn::Lt(x, last));
    } while (!hn::AllFalse(d, active));
  }
  wide_ones.finish();
  return wide_ones.any();
}

// What all that counts down comes to: no counter falls lower.
HWY_INLINE float fall_of(const Crossings& in) {
  const Floats d;
  Vector fall = hn::Zero(d);
  const auto add = [&](CrossingField f, std::size_t count) HWY_ATTR {
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      Vector w = hn::Max(hn::Neg(hn::LoadU(d, in.v[f].data() + i)), hn::Zero(d));
      if (i + hn::Lanes(d) > count) w = hn::IfThenElseZero(hn::FirstN(d, count - i), w);
      fall = hn::Add(fall, w);
    }
  };
  add(cross_weight, in.count), add(event_weight, in.events);
  return hn::GetLane(hn::SumOfLanes(d, fall));
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

// The rows' candidates. `bias` is added to all counters.
template <std::size_t pitch, class T>
HWY_NOINLINE void grid_candidates(const Crossings& in, int columns, int rows, T bias, T* counters, T* sums,
                                  uint64_t* words) {
  const std::size_t places = pitch * static_cast<std::size_t>(rows);
  // In whole vectors: one may hold several rows.
  constexpr std::size_t unit = std::max<std::size_t>(pitch, 64 / sizeof(T));
  const hn::CappedTag<T, pitch> d;
  const std::size_t lanes = hn::Lanes(d);
  std::memset(counters, 0, (places + pitch) * sizeof(T));
  const bool wide = scatter<pitch>(in, (places + unit - 1) / unit * unit, counters, sums);
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
  for (std::size_t c = 0; c < static_cast<std::size_t>(columns); ++c) top[c] = static_cast<T>(top[c] + bias);
  std::fill(top + columns, top + pitch, std::numeric_limits<T>::max());
  for (std::size_t c = 0; c < pitch; c += lanes) {
    auto sum = hn::Load(d, top + c), low = hn::Set(d, std::numeric_limits<T>::max());
    for (std::size_t i = c; i < places; i += pitch) {
      sum = hn::Add(sum, hn::Load(d, counters + i));
      const auto total = wide ? hn::Add(sum, hn::Load(d, sums + i)) : sum;
      hn::Store(total, d, counters + i);
      low = hn::Min(low, total);
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
