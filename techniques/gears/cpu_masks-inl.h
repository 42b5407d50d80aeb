// Triangles onto the mask of one view sample, for grids of light samples: per instruction set.
#if defined(PENUMBRA_GEARS_CPU_MASKS) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_GEARS_CPU_MASKS
#undef PENUMBRA_GEARS_CPU_MASKS
#else
#define PENUMBRA_GEARS_CPU_MASKS
#endif
#include "techniques/gears/cpu_sets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::gears::cpu::HWY_NAMESPACE {

// Rows and columns of light samples, inclusive.
struct Range {
  int32_t c0, c1, r0, r1;
};

// What grids' masks share: a block's triangles, projected and filled in by `Rows`.
template <class Rows>
class GridMask {
 public:
  static constexpr bool grid = true;
  HWY_INLINE GridMask(const LightView& light, const ViewPoint& p, Scratch& scratch)
      : light_(light), p_(p), scratch_(scratch), rows_(light, scratch.mask) {}
  template <bool crossing, class Window>
  HWY_INLINE void add(const Block& block, const Window&) {
    for (std::size_t i = 0; i < block_size; i += hn::Lanes(Floats())) {
      Projection<edges_of<crossing>> t;
      if (!project<crossing>(block, i, p_, light_, t)) continue;
      scratch_.counts.pairs += hn::CountTrue(Floats(), t.use);
      rows_.fill(t);
    }
  }
  HWY_INLINE bool all_blocked() const { return rows_.all_blocked(); }
  HWY_INLINE bool is_open(const Range& range) const { return rows_.is_open(range); }
  HWY_INLINE void finish() const { rows_.finish(); }

 private:
  const LightView& light_;
  const ViewPoint& p_;
  Scratch& scratch_;
  Rows rows_;
};

// Up to 32 columns, and as many rows as some vectors have lanes: in registers, a row to a lane. What was just
// written is there to be read, which it is not where single words go to memory and whole vectors come back.
template <std::size_t vectors>
class RowsInRegisters {
 public:
  HWY_INLINE RowsInRegisters(const LightView&, uint32_t* words) : words_(words) {
    for (std::size_t v = 0; v < vectors; ++v) rows_[v] = hn::Load(Words(), words + v * lanes_in_one());
  }
  HWY_INLINE void finish() const {
    for (std::size_t v = 0; v < vectors; ++v) hn::Store(rows_[v], Words(), words_ + v * lanes_in_one());
  }
  HWY_INLINE bool all_blocked() const {
    auto all = rows_[0];
    for (std::size_t v = 1; v < vectors; ++v) all = hn::And(all, rows_[v]);
    return hn::AllTrue(Words(), hn::Eq(all, hn::Set(Words(), ~0U)));
  }
  HWY_INLINE bool is_open(const Range& range) const {
    const auto columns = hn::Set(Words(), ~0U << range.c0 & ~0U >> (31 - range.c1));
    uint64_t open = 0;
    for (std::size_t v = 0; v < vectors; ++v) {
      const auto some = hn::Ne(hn::AndNot(rows_[v], columns), hn::Zero(Words()));
      open |= static_cast<uint64_t>(bits_of(hn::RebindMask(Floats(), some))) << (v * lanes_in_one());
    }
    return (open & ((uint64_t{2} << range.r1) - (uint64_t{1} << range.r0))) != 0;
  }
  template <int edges>
  HWY_INLINE void fill(const Projection<edges>& t) {
    Spans<edges> spans;
    set_down(t, spans);
    for (uint32_t bits = bits_of(t.use); bits; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
      const Vector first = set(spans.first_row[lane]), last = set(spans.last_row[lane]);
      for (std::size_t v = 0; v < vectors; ++v) {
        const Vector row = hn::Iota(Floats(), static_cast<float>(v * lanes_in_one()));
        Mask some = hn::And(hn::Ge(row, first), hn::Le(row, last));
        const auto covered = bits_of_columns(columns_of(spans, lane, row), 0, &some);
        rows_[v] = hn::Or(rows_[v], hn::IfThenElseZero(hn::RebindMask(Words(), some), covered));
      }
    }
  }

 private:
  static HWY_INLINE std::size_t lanes_in_one() { return hn::Lanes(Floats()); }
  uint32_t* words_;
  hn::Vec<Words> rows_[vectors];
};

// Any grid: in memory.
class RowsInMemory {
 public:
  HWY_INLINE RowsInMemory(const LightView& light, uint32_t* words) : light_(light), words_(words) {}
  HWY_INLINE void finish() const {}
  HWY_INLINE bool all_blocked() const;
  HWY_INLINE bool is_open(const Range& range) const;
  template <int edges>
  HWY_INLINE void fill(const Projection<edges>& t) {
    const Mask tall = hn::And(t.use, hn::Ge(hn::Sub(t.r1, t.r0), set(5)));
    fill_short(t, hn::AndNot(tall, t.use));
    if (hn::AllFalse(Floats(), tall)) return;
    Spans<edges> spans;
    set_down(t, spans);
    for (uint32_t bits = bits_of(tall); bits; bits &= bits - 1)
      fill_tall(spans, static_cast<std::size_t>(__builtin_ctz(bits)));
  }

 private:
  template <int edges>
  HWY_INLINE void fill_short(const Projection<edges>& t, Mask use);
  template <int edges>
  HWY_INLINE void fill_tall(const Spans<edges>& spans, std::size_t lane);
  const LightView& light_;
  uint32_t* words_;
};

HWY_INLINE bool RowsInMemory::all_blocked() const {
  const Words du;
  auto all = hn::Set(du, ~0U);
  for (std::size_t part = 0; part < light_.parts; ++part)
    for (std::size_t r = 0; r < static_cast<std::size_t>(light_.rows); r += hn::Lanes(du))
      all = hn::And(all, hn::Load(du, words_ + part * most_rows + r));
  return hn::AllTrue(du, hn::Eq(all, hn::Set(du, ~0U)));
}

HWY_INLINE bool RowsInMemory::is_open(const Range& range) const {
  const Words du;
  const hn::RebindToSigned<Words> di;
  const auto lanes = static_cast<int32_t>(hn::Lanes(du));
  for (std::size_t part = 0; part < light_.parts; ++part) {
    const int32_t lo = std::max(range.c0 - 32 * static_cast<int32_t>(part), 0),
                  hi = std::min(range.c1 - 32 * static_cast<int32_t>(part), 31);
    if (lo > hi) continue;
    const auto columns = hn::Set(du, ~0U << lo & ~0U >> (31 - hi));
    for (int32_t r = range.r0 / lanes * lanes; r <= range.r1; r += lanes) {
      const auto row = hn::Iota(di, r);
      const auto rows =
          hn::And(hn::Gt(row, hn::Set(di, range.r0 - 1)), hn::Lt(row, hn::Set(di, range.r1 + 1)));
      const auto open =
          hn::AndNot(hn::Load(du, words_ + part * most_rows + static_cast<std::size_t>(r)), columns);
      if (!hn::AllFalse(du, hn::And(hn::RebindMask(du, rows), hn::Ne(open, hn::Zero(du))))) return true;
    }
  }
  return false;
}

// Triangles of few rows: lanes are triangles, one row of each at a time.
template <int edges>
HWY_INLINE void RowsInMemory::fill_short(const Projection<edges>& t, Mask use) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  alignas(64) int32_t rows[block_size];
  alignas(64) uint32_t words[block_size];
  for (Vector row = t.r0; !hn::AllFalse(d, use);) {
    Columns c{t.c0, t.c1};
    for (int k = 0; k < edges; ++k) {
      const Bound& b = t.bounds[k];
      const Vector at = hn::Add(hn::Mul(b.slope, row), b.offset);
      c.from = hn::IfThenElse(b.upper, c.from, hn::Max(c.from, at));
      c.to = hn::IfThenElse(b.upper, hn::Min(c.to, at), c.to);
    }
    c = {hn::Ceil(c.from), hn::Floor(c.to)};
    const Mask covers = hn::And(use, hn::Le(c.from, c.to));
    if (!hn::AllFalse(d, covers)) {
      hn::Store(hn::ConvertTo(di, row), di, rows);
      for (std::size_t part = 0; part < light_.parts; ++part) {
        Mask some = covers;
        hn::Store(bits_of_columns(c, part, &some), Words(), words);
        for (uint32_t bits = bits_of(some); bits; bits &= bits - 1) {
          const auto l = static_cast<std::size_t>(__builtin_ctz(bits));
          words_[part * most_rows + static_cast<std::size_t>(rows[l])] |= words[l];
        }
      }
    }
    row = hn::Add(row, set(1));
    use = hn::And(use, hn::Le(row, t.r1));
  }
}

// A triangle of many rows: lanes are rows.
template <int edges>
HWY_INLINE void RowsInMemory::fill_tall(const Spans<edges>& spans, std::size_t lane) {
  const Words du;
  const auto lanes = static_cast<int32_t>(hn::Lanes(du));
  const auto last = static_cast<int32_t>(spans.last_row[lane]);
  const Vector r0 = set(spans.first_row[lane]), r1 = set(spans.last_row[lane]);
  for (int32_t r = static_cast<int32_t>(spans.first_row[lane]) / lanes * lanes; r <= last; r += lanes) {
    const Vector row = hn::Iota(Floats(), static_cast<float>(r));
    const Columns c = columns_of(spans, lane, row);
    const Mask rows = hn::And(hn::Ge(row, r0), hn::Le(row, r1));
    for (std::size_t part = 0; part < light_.parts; ++part) {
      Mask some = rows;
      const auto bits = bits_of_columns(c, part, &some);
      uint32_t* to = words_ + part * most_rows + static_cast<std::size_t>(r);
      hn::Store(hn::Or(hn::Load(du, to), hn::IfThenElseZero(hn::RebindMask(du, some), bits)), du, to);
    }
  }
}

}  // namespace penumbra::gears::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
