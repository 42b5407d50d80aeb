#include "techniques/stencil_shadow_volume/statistics.h"

#include <cmath>
#include <functional>

namespace penumbra::shadow_volume {
namespace {

constexpr double stencil_values = 256;
// Sides that are drawn over the scene: all of them would hide it.
constexpr std::size_t most_sides = 400;

Mat4d view_of(const LastFrame& last) {
  const ViewSamples& samples = *last.in.view_samples;
  return last.in.scene_case->frame->camera.clip_from_world(samples.width(), samples.height());
}

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
  const Mat4d view = view_of(last);
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

static WorldLines lines_of_sides(const Volumes& volumes, const LastFrame& last) {
  const uint32_t indices = volumes.read_draws().list[LIST_SIDES].index_count,
                 each = volumes.indices_per_quad();
  std::vector<uint32_t> sides(indices);
  gpu::PassRecorder passes(*last.in.scene_case->device);
  if (indices > 0)
    gpu::download(passes, "download", volumes.indices(LIST_SIDES), sides.data(), sides.size() * 4);
  passes.finish();
  const Geometry& g = last.in.scene_case->frame->geometry;
  const Vec4f light = volumes.light().towards;
  const auto at = [&](uint32_t v) {
    const Vec3f p = g.positions[v];
    return Vec4f{p.x, p.y, p.z, 1};
  };
  const auto away = [&](uint32_t v) {
    const Vec3f d = g.positions[v] * light.w - light.xyz();
    return Vec4f{d.x, d.y, d.z, 0};
  };
  WorldLines lines{{}, {"sides of shadow volumes", "silhouette edges"}};
  const std::size_t quads = indices / each, step = every_nth(quads, most_sides);
  for (std::size_t q = 0; q < quads; ++q) {
    // Of a side's vertices two are the edge's; the others are moved to infinity.
    uint32_t ends[2] = {UINT32_MAX, UINT32_MAX};
    for (uint32_t k = 0; k < each; ++k) {
      const uint32_t v = sides[q * each + k];
      if (v >= g.positions.size() || v == ends[0]) continue;
      ends[ends[0] == UINT32_MAX ? 0 : 1] = v;
    }
    if (ends[1] == UINT32_MAX) continue;
    lines.segments.push_back({at(ends[0]), at(ends[1]), 1});
    if (q % step == 0) lines.segments.push_back({at(ends[0]), away(ends[0]), 0});
  }
  return lines;
}

std::vector<Illustration> illustrate(const Volumes& volumes, const StencilPass& stencil,
                                     const LastFrame& last) {
  if (!last.in.view_samples) return {};
  std::vector<Illustration> shown{
      {"volumes_over_scene", "Silhouettes and some sides of shadow volumes", lines_of_sides(volumes, last)}};
  gpu::Device& device = *last.in.scene_case->device;
  if (!FragmentCounts::supported(device)) return shown;
  FragmentCounts counts;
  counts.setup(device);
  shown.push_back({"volume_fragments", "Fragments of shadow volumes in each pixel",
                   PixelFigures{read_counts(device, counts, stencil.image(), [&](gpu::Commands& commands) {
                     counts.fill(commands, volumes, stencil.image(), last.variant, view_of(last),
                                 last.near_plane);
                   })}});
  return shown;
}

}  // namespace penumbra::shadow_volume
