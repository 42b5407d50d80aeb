#include "techniques/line_space/device_tracer.h"

#include <array>
#include <bit>

#include "shaders/line_space_resolve.h"
#include "shaders/line_space_trace.h"
#include "shaders/line_space_trace_images.h"
#include "techniques/common/light_emission.h"

namespace penumbra::line_space {
namespace {

// Some drivers end loops silently after 65,535 turns of an invocation. A walk takes a turn per node that it
// enters or passes: at most 3 nodes per cell along a side on each level, and as many descents.
uint32_t samples_per_dispatch(const Grid& grid) {
  const uint32_t turns = 12 * grid.fine_cells() + 64;
  return std::bit_floor(std::clamp(60000 / turns, 1U, 32U));
}

}  // namespace

void DeviceTracer::setup(gpu::Device& device, uint32_t branching, uint32_t depth, Params::Start start) {
  constexpr std::array images{gpu::ImageUse::sampled_nearest, gpu::ImageUse::sampled_nearest};
  const std::array<gpu::Specialization, 3> constants{
      {{0, branching}, {1, depth}, {2, static_cast<uint32_t>(start)}}};
  trace_ = gpu::ComputePipeline(device, line_space_trace_spv, sizeof(TracePush), constants);
  trace_images_ =
      gpu::ComputePipeline(device, line_space_trace_images_spv, sizeof(TracePush), constants, images);
  resolve_ = gpu::ComputePipeline(device, line_space_resolve_spv, sizeof(ResolvePush));
}

void DeviceTracer::bind(const DeviceTree& tree) {
  if (tree.has_images())
    trace_images_.bind_images(std::array{tree.tree_image().view(), tree.line_space_image().view()});
}

void DeviceTracer::upload(const RenderInput& in, const Grid& grid, gpu::PassRecorder& passes) {
  const Case& c = *in.scene_case;
  const LightSamples& light = *c.light_samples;
  const Vec3f lo = grid.lo, scale = grid.fine_scale();
  values_.emission = light_emission(c.frame->light).emission;
  values_.lo = {lo.x, lo.y, lo.z, 0}, values_.scale = {scale.x, scale.y, scale.z, 0};
  const auto send = [&](gpu::Buffer& buffer, const void* data, std::size_t bytes) {
    gpu::ensure(buffer, *c.device, bytes, gpu::Memory::device, "line space: light");
    gpu::upload(passes, "upload_light", buffer, data, bytes);
  };
  send(constants_, &values_, sizeof values_);
  send(points_, light.points.data(), light.points.size() * sizeof(Vec4f));
  send(weights_, light.weights.data(), light.weights.size() * sizeof(float));
}

void DeviceTracer::run(const RenderInput& in, const Grid& grid, const DeviceTree& tree,
                       gpu::PassRecorder& passes) {
  upload(in, grid, passes);
  const LightSamples& light = *in.scene_case->light_samples;
  const ViewSamples& view = *in.view_samples;
  TracePush push{};
  push.constants = constants_.address();
  push.triangle = view.triangle().address(), push.position = view.position().address();
  push.origin = view.origin().address(), push.normal = view.geometric_normal().address();
  push.points = points_.address();
  push.tree_pool = tree.tree().address(), push.line_space_pool = tree.line_space().address();
  push.mask = in.device.mask->address();
  push.width = static_cast<uint32_t>(view.width()), push.height = static_cast<uint32_t>(view.height());
  push.words = static_cast<uint32_t>(light.mask_words());
  const auto tiles = [](uint32_t side) { return (side + tile_side - 1) / tile_side; };
  const auto count = static_cast<uint32_t>(light.count());
  for (uint32_t first = 0, step = samples_per_dispatch(grid); first < count; first += step) {
    push.first = first, push.end = std::min(first + step, count);
    passes.device_pass("trace", [&](gpu::Commands& commands) {
      commands.dispatch(tree.has_images() ? trace_images_ : trace_, push,
                        uint64_t{tiles(push.width)} * tiles(push.height));
    });
  }
  ResolvePush resolve{};
  resolve.mask = push.mask, resolve.weights = weights_.address();
  resolve.visibility = in.device.visibility->address();
  resolve.weight = light.uniform_weights ? light.weights.front() : 0.0F;
  resolve.pixels = push.width * push.height, resolve.words = push.words, resolve.samples = count;
  passes.device_pass("resolve", [&](gpu::Commands& commands) {
    commands.dispatch(resolve_, resolve, (resolve.pixels + group_lanes - 1) / group_lanes);
  });
}

}  // namespace penumbra::line_space
