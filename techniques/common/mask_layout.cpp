#include "techniques/common/mask_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra {
namespace {

int power_of_two(int n) { return static_cast<int>(std::bit_ceil(static_cast<unsigned>(n))); }

}  // namespace

bool is_regular_grid(const Light& light, const LightSamples& samples) {
  const int w = samples.width, h = samples.height;
  if ((light.kind != LightKind::rectangle && light.kind != LightKind::textured_rectangle) || w < 1 || h < 1)
    return false;
  if (w > 64 || h > 64 || samples.count() != w * h || samples.count() < 2) return false;
  const float tolerance = 1e-5f * light.size() / static_cast<float>(std::max(w, h));
  for (int i = 0; i < samples.count(); ++i) {
    const Vec3f at =
        light.at((static_cast<float>(i % w) + 0.5f + samples.grid_shift.x) / static_cast<float>(w),
                 (static_cast<float>(i / w) + 0.5f + samples.grid_shift.y) / static_cast<float>(h));
    const Vec4f p = samples.points[static_cast<std::size_t>(i)];
    const float rounding = 1e-6f * (std::abs(at.x) + std::abs(at.y) + std::abs(at.z));
    if (p.w == 0 || length(p.xyz() - at) > tolerance + rounding) return false;
  }
  return true;
}

MaskLayout mask_layout(const Light& light, const LightSamples& samples) {
  MaskLayout m;
  m.samples = samples.count();
  m.words = m.mask_words = samples.mask_words();
  m.weighted = !samples.uniform_weights;
  m.infinite = samples.points.front().w == 0;
  m.move = samples.move;
  m.grid = is_regular_grid(light, samples);
  m.columns = m.samples;
  if (!m.grid) return m;
  m.columns = samples.width;
  m.rows = samples.height;
  // Few rows take the whole word, so that no row of it is idle.
  m.pitch = std::max(power_of_two(m.columns), 32 / std::min(32, power_of_two(m.rows)));
  m.words = m.pitch == 64 ? 2 * m.rows : (m.rows * m.pitch + 31) / 32;
  m.packed = m.pitch == m.columns && m.words == m.mask_words;
  return m;
}

}  // namespace penumbra
