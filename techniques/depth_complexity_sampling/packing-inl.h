// Moves the lanes that a mask selects to the front, for several vectors: per instruction set.
#if defined(PENUMBRA_DEPTH_COMPLEXITY_PACKING) == defined(HWY_TARGET_TOGGLE)
#ifdef PENUMBRA_DEPTH_COMPLEXITY_PACKING
#undef PENUMBRA_DEPTH_COMPLEXITY_PACKING
#else
#define PENUMBRA_DEPTH_COMPLEXITY_PACKING
#endif
#include "techniques/common/lanes-inl.h"
#include "techniques/depth_complexity_sampling/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace penumbra::depth_complexity::HWY_NAMESPACE {
using namespace lanes::HWY_NAMESPACE;

static_assert(most_lanes == block_edges);

#if HWY_HAVE_SCALABLE || HWY_TARGET <= HWY_AVX3
// Instructions of their own. Not the ones that store as they pack: those are slow on some processors.
class Packing {
 public:
  explicit HWY_INLINE Packing(Mask m) : mask_(m), count_(hn::CountTrue(Floats(), m)) {}
  HWY_INLINE void store(Vector v, float* to) const { hn::StoreU(hn::Compress(v, mask_), Floats(), to); }
  HWY_INLINE std::size_t count() const { return count_; }

 private:
  Mask mask_;
  std::size_t count_;
};
#else
// By a permutation looked up once for all vectors. Highway's own Compress() copies its table onto the stack
// at each call, as GCC compiles it.
class Packing {
 public:
  explicit HWY_INLINE Packing(Mask m) : Packing(bits_of(m)) {}
  HWY_INLINE void store(Vector v, float* to) const {
    hn::StoreU(hn::TableLookupLanes(v, indices_), Floats(), to);
  }
  HWY_INLINE std::size_t count() const { return count_; }

 private:
  explicit HWY_INLINE Packing(uint32_t bits)
      : indices_(hn::IndicesFromVec(Floats(), load(bits))), count_(packing_table[bits].count) {}
  using Integers = hn::RebindToSigned<Floats>;
  static HWY_INLINE hn::Vec<Integers> load(uint32_t bits) {
    return hn::PromoteTo(Integers(), hn::LoadU(hn::Rebind<uint8_t, Integers>(), packing_table[bits].lane));
  }
  decltype(hn::IndicesFromVec(Floats(), hn::Zero(Integers()))) indices_;
  std::size_t count_;
};
#endif

}  // namespace penumbra::depth_complexity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
