#include "techniques/stencil_shadow_volume/statistics.h"

#include <cmath>
#include <functional>

namespace penumbra::shadow_volume {
namespace {

constexpr double stencil_values = 256;

// Draws counts and reads them back.
std::vector<float> read_counts(gpu::Device& device, FragmentCounts& counts, const gpu::Image& depth,
                               const std::function<void(gpu::Commands&)>& draw) {
  const std::size_t pixels = std::size_t{depth.desc().width} * depth.desc().height;
  const gpu::Buffer read_back(device, pixels * sizeof(float), gpu::Memory::read_back, "fragment counts");
  gpu::PassRecorder passes(device);
  passes.device_pass("statistics", [&](gpu::Commands& commands) {
    if (counts.ensure(device, depth)) commands.initialise(counts.image());
    draw(commands);
    commands.barrier();
    commands.copy_image_to_buffer(counts.image(), read_back, VK_IMAGE_ASPECT_COLOR_BIT);
  });
  passes.finish();
  const std::span<float> all = read_back.view<float>();
  return {all.begin(), all.end()};
}

}  // namespace

Counters count(const Params& params, Volumes& volumes, const StencilPass& stencil, const LastFrame& last) {
  Counters out;
  if (!last.in.view_samples) return out;
  const Draws draws = volumes.read_draws();
  const bool silhouette = params.extrusion == Extrusion::silhouette;
  out["quads"] =
      double(silhouette ? draws.quads : draws.list[LIST_SIDES].index_count / volumes.indices_per_quad());
  if (silhouette) out["silhouette_edges"] = double(draws.silhouette_edges);
  uint64_t triangles = 0;
  for (const DrawArguments& a : draws.list) triangles += a.index_count / 3;
  out["volume_triangles"] = double(triangles);
  out["fell_back"] = double(last.fell_back);
  out["wide_counts"] = last.wide ? 1.0 : 0.0;
  out["layer_bound"] = double(last.layers);
  gpu::Device& device = *last.in.scene_case->device;
  if (!FragmentCounts::supported(device)) return out;

  const ViewSamples& samples = *last.in.view_samples;
  const Mat4d view = last.in.scene_case->frame->camera.clip_from_world(samples.width(), samples.height());
  FragmentCounts counts;  // its own: what the technique holds stays as it was
  counts.setup(device);
  const auto read_volumes = [&](Variant variant, const std::optional<Mat4d>& near_plane) {
    return read_counts(device, counts, stencil.image(), [&](gpu::Commands& commands) {
      counts.volumes(commands, volumes, stencil.image(), variant, view, near_plane);
    });
  };
  double fragments = 0, largest = 0, wrapped = 0;
  const std::vector<float> fill = read_counts(device, counts, stencil.image(), [&](gpu::Commands& commands) {
    counts.fill(commands, volumes, stencil.image(), last.variant, view, last.near_plane);
  });
  for (float f : fill) fragments += double(f);
  out["fragments"] = fragments, out["overdraw"] = fragments / double(fill.size());
  const std::vector<float> held = read_volumes(last.variant, last.near_plane);
  for (float v : held) {
    largest = std::max(largest, std::abs(double(v)));
    wrapped += !last.wide && v != 0 && std::fmod(double(v), stencil_values) == 0;
  }
  out["largest_count"] = largest, out["wrapped_pixels"] = wrapped;
  if (last.variant != Variant::zp_plus) return out;
  gpu::PassRecorder passes(device);
  volumes.extract(*last.in.scene_case, volumes.light(), Variant::z_fail, passes);
  passes.finish();
  const std::vector<float> truth = read_volumes(Variant::z_fail, std::nullopt);
  double streaks = 0;
  for (std::size_t i = 0; i < held.size(); ++i)
    streaks += samples.host().triangle[i] != no_triangle && held[i] != truth[i];
  out["streak_pixels"] = streaks;
  return out;
}

}  // namespace penumbra::shadow_volume
