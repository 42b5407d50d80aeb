#include "techniques/line_space/host_tracer.h"

#include "core/parallel.h"
#include "techniques/common/light_emission.h"
#include "techniques/line_space/glsl.h"

namespace penumbra::line_space {
namespace {

// The shader's code with the host's pools.
struct Walker {
  const uint32_t* tree;
  const uint32_t* line_space;
  uint N, DEPTH, START;
  uint tree_entry(uint place) const { return tree[place]; }
  uint line_space_word(uint place) const { return line_space[place]; }
#include "techniques/line_space/shaders/traverse.glsl"
};

Vec3f scaled(Vec3f a, Vec3f b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

// As shaders/light_emission.glsl.
bool may_be_lit(Vec3f point, Vec3f normal, Vec4f towards, Vec4f emission) {
  const Vec3f to_light = towards.xyz() - point * towards.w;
  return dot(normal, to_light) > 0 &&
         (emission.w <= -1 || dot(emission.xyz(), -to_light) >= emission.w * length(to_light));
}

}  // namespace

bool HostTracer::blocked(Vec3f origin, Vec4f light_point) const {
  Walker walker{pools_.tree.data(), pools_.line_space.data(), grid_.branching, grid_.depth, start_};
  const Vec3f o = scaled(origin - grid_.lo, grid_.fine_scale());
  const Vec3f d = scaled(light_point.xyz() - origin * light_point.w, grid_.fine_scale());
  Walker::Walk w = walker.begin_walk(o, d, light_point.w > 0.5F ? 1.000001F : walker.far_away);
  while (!w.done) w = walker.step_walk(w);
  return w.blocked;
}

bool HostTracer::start_cell(Vec3f origin, Vec3f& cell) const {
  Walker walker{pools_.tree.data(), pools_.line_space.data(), grid_.branching, grid_.depth, start_};
  cell = walker.begin_walk(scaled(origin - grid_.lo, grid_.fine_scale()), {0, 0, 0}, 1).start;
  return cell.x >= 0;
}

void HostTracer::pixel(const LightSamples& samples, Vec4f emission, const ViewSamplesHost& view,
                       std::size_t i, uint32_t* mask, float& visibility) const {
  std::fill_n(mask, samples.mask_words(), 0U);
  visibility = 1;
  if (view.triangle[i] == no_triangle) return;
  double lit = 0;
  int clear = 0;
  for (std::size_t s = 0; s < samples.points.size(); ++s) {
    const Vec4f l = samples.points[s];
    const bool dark = !may_be_lit(view.position[i].xyz(), view.geometric_normal[i].xyz(), l, emission) ||
                      blocked(view.origin[i].xyz(), l);
    if (dark) mask[s / 32] |= 1U << (s % 32);
    if (!dark) ++clear, lit += static_cast<double>(samples.weights[s]);
  }
  visibility = samples.uniform_weights ? static_cast<float>(clear) / static_cast<float>(samples.count())
                                       : std::min(static_cast<float>(lit), 1.0F);
}

void HostTracer::run(const Light& light, const LightSamples& samples, const ViewSamplesHost& view,
                     std::span<uint32_t> mask, std::span<float> visibility) const {
  const Vec4f emission = light_emission(light).emission;
  const auto words = static_cast<std::size_t>(samples.mask_words());
  parallel_for(view.pixel_count(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      pixel(samples, emission, view, i, mask.data() + i * words, visibility[i]);
  });
}

}  // namespace penumbra::line_space
