// Integers in the order of the floats, so that atomicMin() finds the least float; from_ordered() of light_frame.h is
// the inverse. Maxima are kept as minima of the complement: one fill with ones resets both.
uint ordered(float f) {
  const uint u = floatBitsToUint(f);
  return (u & 0x80000000u) != 0u ? ~u : u | 0x80000000u;
}
