// Van der Corput's sequence, of which Halton's are made.
#pragma once
#include <cstdint>

namespace penumbra {

// The digits of i in the base, mirrored at the point: in [0, 1).
inline double radical_inverse(uint32_t i, uint32_t base) {
  double inverse = 1, value = 0;
  for (; i; i /= base) value += (inverse /= base) * (i % base);
  return value;
}

}  // namespace penumbra
