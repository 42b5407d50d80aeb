#include "core/hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace penumbra {

struct Hasher::State {
  XXH3_state_t xxh;
};

Hasher::Hasher() : state_(std::make_unique<State>()) { XXH3_128bits_reset(&state_->xxh); }
Hasher::~Hasher() = default;

Hasher& Hasher::bytes(const void* data, std::size_t size) {
  if (size != 0) XXH3_128bits_update(&state_->xxh, data, size);
  return *this;
}

Hasher& Hasher::text(std::string_view s) {
  value(s.size());
  return bytes(s.data(), s.size());
}

std::string Hasher::hex() const {
  const XXH128_hash_t h = XXH3_128bits_digest(&state_->xxh);
  static constexpr char digits[] = "0123456789abcdef";
  std::string out;
  for (const XXH64_hash_t part : {h.high64, h.low64})
    for (int shift = 60; shift >= 0; shift -= 4) out += digits[(part >> shift) & 15U];
  return out;
}

}  // namespace penumbra
