#include "techniques/soft_shadow_volume/illustrations.h"

namespace penumbra::soft_shadow_volume {
namespace {

// Wedges whose rays are drawn over the scene: all of them would hide it.
constexpr std::size_t most_wedges = 60;

Vec4f point(const Vec4f& p) { return {p.x, p.y, p.z, 1}; }

WorldLines lines_of(const std::vector<Wedge>& wedges) {
  WorldLines lines{{}, {"rays of penumbra wedges", "silhouette edges"}};
  const std::size_t step = every_nth(wedges.size(), most_wedges);
  for (std::size_t i = 0; i < wedges.size(); ++i) {
    const Wedge& w = wedges[i];
    lines.segments.push_back({point(w.edge[0]), point(w.edge[1]), 1});
    const auto rays = static_cast<uint32_t>(w.edge[1].w);
    if (i % step != 0 || rays > MOST_DIRECTIONS) continue;
    for (uint32_t r = 0; r < rays; ++r) {
      const Vec4f& ray = w.ring[r];  // w of the first apex: 1 where rays end, 0 where they go to infinity
      lines.segments.push_back(
          {point(w.apex[ray.w > 0 ? 1 : 0]), Vec4f{ray.x, ray.y, ray.z, w.apex[0].w}, 0});
    }
  }
  return lines;
}

}  // namespace

std::vector<Illustration> illustrate(WedgePass& wedges, Silhouettes& silhouettes,
                                     const std::vector<Part>& parts, const RenderInput& in,
                                     gpu::PassRecorder& passes) {
  PixelFigures drawn{std::vector<float>(in.view_samples->host().pixel_count())}, counted = drawn;
  WorldLines lines;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    silhouettes.extract(*in.scene_case, parts[i], passes);
    const WedgePass::Wedges part = wedges.read(in, silhouettes, parts[i], passes);
    if (i == 0) lines = lines_of(part.wedges);
    for (std::size_t k = 0; k < drawn.values.size(); ++k)
      drawn.values[k] += part.sums[k].x, counted.values[k] += part.sums[k].y;
  }
  return {{"wedges_over_scene", "Silhouettes, and some of their penumbra wedges", std::move(lines)},
          {"wedges_per_view_sample", "Penumbra wedges drawn over each view sample", std::move(drawn)},
          {"edges_hiding_light", "Silhouette edges that hide a part of the light from each view sample",
           std::move(counted)}};
}

}  // namespace penumbra::soft_shadow_volume
