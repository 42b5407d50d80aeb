#include "techniques/depth_complexity_sampling/morton.h"

#include <array>
#include <utility>

#include "core/parallel.h"

namespace penumbra::depth_complexity {
namespace {

constexpr uint32_t cells = 1024;  // per axis
constexpr int digit_bits = 10;
constexpr std::size_t digits = 1U << digit_bits;

uint32_t spread(uint32_t x) {
  x = (x | x << 16) & 0x030000ffU;
  x = (x | x << 8) & 0x0300f00fU;
  x = (x | x << 4) & 0x030c30c3U;
  return (x | x << 2) & 0x09249249U;
}

}  // namespace

MortonCode::MortonCode(const Box& box) : lo_(box.lo) {
  const Vec3f size = box.hi - box.lo;
  const float largest = std::max({size.x, size.y, size.z});
  scale_ = largest > 0 ? static_cast<float>(cells) / largest : 0.0F;
}

uint32_t MortonCode::operator()(Vec3f p) const {
  const auto cell = [&](float x, float lo) {
    const float c = (x - lo) * scale_;
    return c > 0 ? static_cast<uint32_t>(std::min(c, static_cast<float>(cells - 1))) : 0U;  // NaN: 0
  };
  return spread(cell(p.x, lo_.x)) | spread(cell(p.y, lo_.y)) << 1 | spread(cell(p.z, lo_.z)) << 2;
}

void sort_by_code(std::vector<Keyed>& keys, std::vector<Keyed>& spare) {
  const std::size_t n = keys.size(), chunks = std::max<std::size_t>(1, std::min<std::size_t>(64, n / 8192)),
                    chunk = (n + chunks - 1) / chunks;
  std::vector<std::array<uint32_t, digits>> place(chunks);
  for (int pass = 0; pass < 3; ++pass) {
    const int shift = pass * digit_bits;
    const auto digit = [shift](const Keyed& k) { return k.code >> shift & (digits - 1); };
    const auto each_chunk = [&](const auto& body) {
      parallel_for(chunks, 1, [&](std::size_t c, std::size_t) {
        for (std::size_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) body(place[c], keys[i]);
      });
    };
    for (auto& p : place) p.fill(0);
    each_chunk([&](auto& p, const Keyed& k) { ++p[digit(k)]; });
    uint32_t sum = 0;
    for (std::size_t d = 0; d < digits; ++d)
      for (auto& p : place) sum += std::exchange(p[d], sum);
    each_chunk([&](auto& p, const Keyed& k) { spare[p[digit(k)]++] = k; });
    keys.swap(spare);
  }
}

}  // namespace penumbra::depth_complexity
