// Vectors of up to 16 floats, for the techniques that run on the host: per instruction set.
#if defined(PENUMBRA_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_LANES
#undef PENUMBRA_LANES
#else
#define PENUMBRA_LANES
#endif
#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace penumbra::lanes::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::size_t most_lanes = 16;
using Floats = hn::CappedTag<float, most_lanes>;
using Words = hn::RebindToUnsigned<Floats>;
using Vector = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

HWY_INLINE Vector set(float v) { return hn::Set(Floats(), v); }

// Bit i: lane i.
HWY_INLINE uint32_t bits_of(Mask m) {
  alignas(16) uint8_t bytes[16] = {};
  hn::StoreMaskBits(Floats(), m, bytes);
  return static_cast<uint32_t>(bytes[0]) | static_cast<uint32_t>(bytes[1]) << 8;
}

// The lanes whose sign bit is set: those of -0 too.
HWY_INLINE Mask sign_bit(Vector v) {
  const hn::RebindToSigned<Floats> di;
  return hn::RebindMask(Floats(), hn::Lt(hn::BitCast(di, v), hn::Zero(di)));
}

}  // namespace penumbra::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
