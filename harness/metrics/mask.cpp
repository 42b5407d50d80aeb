#include <bit>

#include "metrics/checks.h"
#include "metrics/metrics.h"

namespace penumbra {

MaskMismatch mask_mismatch(std::span<const uint32_t> reference, std::span<const uint32_t> test,
                           int words_per_pixel, int light_samples, std::span<const uint8_t> evaluated) {
  if (light_samples < 1 || words_per_pixel != (light_samples + 31) / 32)
    throw InputError("Masks of " + std::to_string(light_samples) + " light samples cannot have " +
                     std::to_string(words_per_pixel) + " words per pixel.");
  check_array("The test mask", test.size(), reference.size());
  const std::size_t words = static_cast<std::size_t>(words_per_pixel);
  const std::size_t pixels = reference.size() / words;
  check_array("The reference mask", reference.size(), pixels * words);
  if (!evaluated.empty()) check_array("The evaluated mask", evaluated.size(), pixels);

  // Bits past the last light sample mean nothing, whatever a technique left there.
  const int used = (light_samples - 1) % 32 + 1;
  const uint32_t last_word = 0xffffffffU >> (32 - used);
  MaskMismatch m;
  for (std::size_t p = 0; p < pixels; ++p) {
    if (!evaluated.empty() && !evaluated[p]) continue;
    uint64_t off = 0;
    for (std::size_t w = 0; w < words; ++w) {
      const uint32_t valid = w + 1 == words ? last_word : 0xffffffffU;
      const uint32_t different = (reference[p * words + w] ^ test[p * words + w]) & valid;
      if (different != 0)
        off += static_cast<uint64_t>(std::popcount(different));  // rare, and a call without SSE4
    }
    m.bits_off += off;
    m.pixels_off += off > 0;
    m.bits += static_cast<uint64_t>(light_samples);
    ++m.pixels;
  }
  return m;
}

}  // namespace penumbra
