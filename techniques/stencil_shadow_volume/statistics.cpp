#include "techniques/stencil_shadow_volume/statistics.h"

#include <array>
#include <bit>
#include <cmath>

#include "shaders/shadow_volume_count.h"
#include "shaders/shadow_volume_volume.h"

namespace penumbra::shadow_volume {
namespace {

constexpr VkFormat count_format = VK_FORMAT_R32_SFLOAT;
constexpr double stencil_values = 256;

bool can_count(gpu::Device& device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical(), count_format, &properties);
  return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
}

// Sums over the fragments of each pixel.
class FragmentCounts {
 public:
  FragmentCounts(const RenderInput& in, const Volumes& volumes, const StencilPass& stencil)
      : in_(in), volumes_(volumes), stencil_(stencil), device_(*in.scene_case->device), passes_(device_) {
    gpu::ImageDesc desc;
    desc.width = stencil.image().desc().width, desc.height = stencil.image().desc().height;
    desc.format = count_format;
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    counts_ = gpu::Image(device_, desc, "shadow volumes: fragment counts");
    read_back_ = gpu::Buffer(device_, pixels() * sizeof(float), gpu::Memory::read_back, "fragment counts");
  }

  // Every fragment that is made, whatever the depth test says.
  std::vector<float> fill(Variant variant, const std::optional<Mat4d>& near_plane) {
    const bool clamp = variant == Variant::z_fail;
    const gpu::GraphicsPipeline all = pipeline(1, 1, VK_COMPARE_OP_ALWAYS, clamp);
    return draw([&](gpu::Commands& c) {
      draw_lists(c, all, view(), {LIST_SIDES});
      if (clamp) draw_lists(c, all, view(), {LIST_NEAR_FRONT, LIST_NEAR_BACK, LIST_FAR});
      if (near_plane) draw_lists(c, all, *near_plane, {LIST_NEAR_FRONT, LIST_NEAR_BACK});
    });
  }

  // The count that the stencil holds modulo 256.
  std::vector<float> volumes(Variant variant, const std::optional<Mat4d>& near_plane) {
    if (variant == Variant::z_fail) {
      const gpu::GraphicsPipeline behind = pipeline(-1, 1, VK_COMPARE_OP_LESS_OR_EQUAL, true);
      const gpu::GraphicsPipeline cap = pipeline(-1, 1, VK_COMPARE_OP_LESS_OR_EQUAL, false);
      const gpu::GraphicsPipeline flipped = pipeline(1, -1, VK_COMPARE_OP_LESS_OR_EQUAL, false);
      return draw([&](gpu::Commands& c) {
        draw_lists(c, behind, view(), {LIST_SIDES, LIST_FAR});
        draw_lists(c, cap, view(), {LIST_NEAR_FRONT});
        draw_lists(c, flipped, view(), {LIST_NEAR_BACK});
      });
    }
    const gpu::GraphicsPipeline before = pipeline(1, -1, VK_COMPARE_OP_GREATER, false);
    const gpu::GraphicsPipeline near = pipeline(1, 1, VK_COMPARE_OP_ALWAYS, false);
    return draw([&](gpu::Commands& c) {
      if (near_plane) draw_lists(c, near, *near_plane, {LIST_NEAR_FRONT, LIST_NEAR_BACK});
      draw_lists(c, before, view(), {LIST_SIDES});
    });
  }

 private:
  std::size_t pixels() const { return std::size_t{counts_.desc().width} * counts_.desc().height; }
  Mat4d view() const {
    return in_.scene_case->frame->camera.clip_from_world(in_.view_samples->width(),
                                                         in_.view_samples->height());
  }

  gpu::GraphicsPipeline pipeline(float front, float back, VkCompareOp compare, bool depth_clamp) const {
    gpu::GraphicsDesc desc;
    desc.vertex = shadow_volume_volume_spv, desc.fragment = shadow_volume_count_spv;
    desc.push_bytes = sizeof(VolumePush);
    desc.constants = {{0, std::bit_cast<uint32_t>(front)}, {1, std::bit_cast<uint32_t>(back)}};
    desc.color_formats = {count_format}, desc.blend_add = true, desc.write_mask = VK_COLOR_COMPONENT_R_BIT;
    desc.depth_format = stencil_format, desc.depth_clamp = depth_clamp;
    desc.depth_test = compare != VK_COMPARE_OP_ALWAYS, desc.depth_compare = compare;
    return gpu::GraphicsPipeline(device_, desc);
  }

  void draw_lists(gpu::Commands& commands, const gpu::GraphicsPipeline& pipeline,
                  const Mat4d& clip_from_world, std::initializer_list<uint32_t> lists) const {
    commands.bind(pipeline);
    const VolumePush push = volumes_.push(clip_from_world);
    commands.push(pipeline, &push, sizeof push);
    for (uint32_t list : lists) volumes_.draw(commands, list);
  }

  std::vector<float> draw(const std::function<void(gpu::Commands&)>& lists) {
    passes_.device_pass("statistics", [&](gpu::Commands& commands) {
      commands.initialise(counts_);
      const gpu::RenderTarget color{.view = counts_.view()};
      const gpu::RenderTarget depth{.view = stencil_.image().view(), .load = VK_ATTACHMENT_LOAD_OP_LOAD};
      commands.begin_rendering(counts_.desc().width, counts_.desc().height, std::array{color}, &depth,
                               stencil_format);
      lists(commands);
      commands.end_rendering();
      commands.barrier();
      commands.copy_image_to_buffer(counts_, read_back_, VK_IMAGE_ASPECT_COLOR_BIT);
    });
    passes_.finish();
    const std::span<float> counts = read_back_.view<float>();
    return {counts.begin(), counts.end()};
  }

  const RenderInput& in_;
  const Volumes& volumes_;
  const StencilPass& stencil_;
  gpu::Device& device_;
  gpu::PassRecorder passes_;
  gpu::Image counts_;
  gpu::Buffer read_back_;
};

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
  out["fell_back"] = last.fell_back ? 1.0 : 0.0;
  if (!can_count(*last.in.scene_case->device)) return out;

  FragmentCounts counts(last.in, volumes, stencil);
  double fragments = 0, largest = 0, wrapped = 0;
  const std::vector<float> fill = counts.fill(last.variant, last.near_plane);
  for (float f : fill) fragments += double(f);
  out["fragments"] = fragments, out["overdraw"] = fragments / double(fill.size());
  const std::vector<float> held = counts.volumes(last.variant, last.near_plane);
  for (float v : held) {
    largest = std::max(largest, std::abs(double(v)));
    wrapped += v != 0 && std::fmod(double(v), stencil_values) == 0;
  }
  out["largest_count"] = largest, out["wrapped_pixels"] = wrapped;
  if (last.variant != Variant::zp_plus) return out;
  gpu::PassRecorder passes(*last.in.scene_case->device);
  volumes.extract(*last.in.scene_case, Variant::z_fail, passes);
  passes.finish();
  const std::vector<float> truth = counts.volumes(Variant::z_fail, std::nullopt);
  double streaks = 0;
  for (std::size_t i = 0; i < held.size(); ++i)
    streaks += last.in.view_samples->host().triangle[i] != no_triangle && held[i] != truth[i];
  out["streak_pixels"] = streaks;
  return out;
}

}  // namespace penumbra::shadow_volume
