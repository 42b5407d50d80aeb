// What every metric asks of its input before it computes anything.
#pragma once
#include <cmath>
#include <string>

#include "core/error.h"
#include "metrics/metrics.h"

namespace penumbra {

inline std::size_t pixel_count(int width, int height) {
  return width > 0 && height > 0 ? static_cast<std::size_t>(width) * static_cast<std::size_t>(height) : 0;
}

inline std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

// Pixels that count: those that both images evaluate.
inline bool is_evaluated(const ScalarImage& a, const ScalarImage& b, std::size_t i) {
  return (a.evaluated.empty() || a.evaluated[i]) && (b.evaluated.empty() || b.evaluated[i]);
}

inline void check_array(const char* what, std::size_t found, std::size_t expected) {
  if (found != expected)
    throw InputError(std::string(what) + " has " + std::to_string(found) + " values, its size asks for " +
                     std::to_string(expected) + ".");
}

inline void check_same_size(const ScalarImage& reference, const ScalarImage& test) {
  if (reference.width != test.width || reference.height != test.height)
    throw InputError("The images differ in size: the reference is " +
                     size_text(reference.width, reference.height) + ", the test " +
                     size_text(test.width, test.height) + ".");
  const std::size_t pixels = pixel_count(reference.width, reference.height);
  check_array("The reference", reference.values.size(), pixels);
  check_array("The test image", test.values.size(), pixels);
  if (!reference.evaluated.empty())
    check_array("The reference's evaluated mask", reference.evaluated.size(), pixels);
  if (!test.evaluated.empty()) check_array("The test image's evaluated mask", test.evaluated.size(), pixels);
}

inline void check_finite(const char* what, float value, std::size_t i, int width) {
  if (std::isfinite(value)) return;
  const std::size_t w = static_cast<std::size_t>(width);
  throw InputError(std::string(what) + " has the value " + std::to_string(value) + " at pixel (" +
                   std::to_string(i % w) + ", " + std::to_string(i / w) + "), a finite one was expected.");
}

}  // namespace penumbra
