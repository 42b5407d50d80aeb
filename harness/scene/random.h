// PCG32 (O'Neill 2014, XSH-RR): small, well tested, and the same numbers on every platform and standard
// library.
#pragma once
#include <cstdint>

namespace penumbra {

class Pcg32 {
 public:
  explicit Pcg32(uint64_t seed, uint64_t stream = 1) : state_(0), increment_((stream << 1U) | 1U) {
    next();
    state_ += seed;
    next();
  }
  uint32_t next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005U + increment_;
    const auto mixed = static_cast<uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<uint32_t>(old >> 59U);
    return (mixed >> turn) | (mixed << ((32U - turn) & 31U));
  }
  // Uniform in [lo, hi).
  double uniform(double lo, double hi) { return lo + (hi - lo) * (next() * 0x1p-32); }

 private:
  uint64_t state_, increment_;
};

}  // namespace penumbra
