#include "techniques/planar_shadow/projector.h"

#include <array>

#include "shaders/planar_shadow_flatten.h"
#include "shaders/planar_shadow_gather.h"
#include "techniques/common/light_emission.h"
#include "techniques/planar_shadow/shaders/shared.h"

namespace penumbra::planar_shadow {
namespace {

constexpr VkFormat stencil_format = VK_FORMAT_D32_SFLOAT_S8_UINT;
constexpr uint32_t group = 64;
constexpr int batch = 8;              // light samples per stencil
constexpr double lowest = 1e-6;       // scene diagonals: what lies in the plane casts nothing onto it
constexpr double highest = 1 - 1e-6;  // of the light's height

// Sets one bit, however often the pixel is covered.
gpu::GraphicsPipeline make_mark(gpu::Device& device, uint32_t bit) {
  gpu::GraphicsDesc desc;
  desc.vertex = planar_shadow_flatten_spv;
  desc.push_bytes = sizeof(FlattenPush);
  desc.vertex_strides = {3 * sizeof(float)};
  desc.depth_format = stencil_format;
  desc.stencil_test = true;
  VkStencilOpState s{};
  s.passOp = s.failOp = s.depthFailOp = VK_STENCIL_OP_REPLACE, s.compareOp = VK_COMPARE_OP_ALWAYS;
  s.compareMask = s.reference = 0xff, s.writeMask = 1U << bit;
  desc.stencil_front = desc.stencil_back = s;
  return gpu::GraphicsPipeline(device, desc);
}

double height(Vec4d plane, Vec4d light) {
  return plane.x * light.x + plane.y * light.y + plane.z * light.z + plane.w * light.w;
}

}  // namespace

std::optional<std::string> missing(gpu::Device& device) {
  VkPhysicalDeviceFeatures features;
  vkGetPhysicalDeviceFeatures(device.physical(), &features);
  if (!features.shaderClipDistance)
    return "The device has no clip distances, which cut off what lies behind the plane or beyond the light.";
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical(), stencil_format, &properties);
  constexpr VkFormatFeatureFlags needed =
      VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_TRANSFER_SRC_BIT;
  if ((properties.optimalTilingFeatures & needed) != needed)
    return "The device cannot render to and copy 32-bit depth with an 8-bit stencil.";
  return {};
}

void Projector::setup(gpu::Device& device) {
  for (uint32_t bit = 0; bit < batch; ++bit) mark_[bit] = make_mark(device, bit);
  gather_ = gpu::ComputePipeline(device, planar_shadow_gather_spv, sizeof(GatherPush));
}

void Projector::build(const Case& c, const Receiver& receiver, gpu::PassRecorder& passes) {
  constexpr const char* pass = "upload_occluders";
  const Geometry& g = c.frame->geometry;
  const std::vector<uint32_t> indices = occluder_indices(g, receiver.instance);
  std::vector<uint32_t> bits((g.triangle_count() + 31) / 32, 0);
  for (std::size_t t = 0; t < g.triangle_count(); ++t)
    if (g.triangle_instance[t] == receiver.instance) bits[t / 32] |= 1U << (t % 32);
  index_count_ = static_cast<uint32_t>(indices.size());
  gpu::ensure(indices_, *c.device, std::max<std::size_t>(indices.size(), 1) * sizeof(uint32_t),
              gpu::Memory::device, "planar shadow: occluders");
  gpu::ensure(on_receiver_, *c.device, bits.size() * sizeof(uint32_t), gpu::Memory::device,
              "planar shadow: receiver");
  if (index_count_) gpu::upload(passes, pass, indices_, indices.data(), indices.size() * sizeof(uint32_t));
  gpu::upload(passes, pass, on_receiver_, bits.data(), bits.size() * sizeof(uint32_t));
  passes.finish();  // the arrays that it copies from end here
}

void Projector::ensure(const RenderInput& in, gpu::PassRecorder& passes) {
  gpu::Device& device = *in.scene_case->device;
  const LightSamples& light = *in.scene_case->light_samples;
  gpu::ensure(points_, device, light.points.size() * sizeof(Vec4f), gpu::Memory::device,
              "planar shadow: light");
  gpu::ensure(weights_, device, light.weights.size() * sizeof(float), gpu::Memory::device,
              "planar shadow: light");
  gpu::upload(passes, "upload_light", points_, light.points.data(), light.points.size() * sizeof(Vec4f));
  gpu::upload(passes, "upload_light", weights_, light.weights.data(), light.weights.size() * sizeof(float));
  const auto width = static_cast<uint32_t>(in.view_samples->width()),
             height = static_cast<uint32_t>(in.view_samples->height());
  if (image_ && image_.desc().width == width && image_.desc().height == height) return;
  gpu::ImageDesc desc;
  desc.width = width, desc.height = height, desc.format = stencil_format;
  desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  image_ = gpu::Image(device, desc, "planar shadow: stencil");
  gpu::ensure(stencil_, device, (std::size_t{width} * height + 3) / 4 * 4, gpu::Memory::device,
              "planar shadow: stencil");
  passes.device_pass("flatten", [&](gpu::Commands& commands) { commands.initialise(image_); });
}

void Projector::flatten(gpu::Commands& commands, const RenderInput& in, const Receiver& receiver,
                        int first) const {
  const Case& c = *in.scene_case;
  const Mat4d view = c.frame->camera.clip_from_world(in.view_samples->width(), in.view_samples->height());
  const gpu::RenderTarget target{.view = image_.view()};
  commands.begin_rendering(image_.desc().width, image_.desc().height, {}, &target, stencil_format);
  const std::array buffers{c.geometry->positions.handle()};
  commands.vertex_buffers(buffers);
  for (int i = first; i < std::min(first + batch, c.light_samples->count()) && index_count_; ++i) {
    const Vec4f l = c.light_samples->points[static_cast<std::size_t>(i)];
    const Vec4d light{l.x, l.y, l.z, l.w};
    const double above = height(receiver.plane, light), side = above < 0 ? -1 : 1;
    if (above == 0) continue;  // the light grazes the plane: below every horizon
    FlattenPush push{};
    push.clip_from_world = to_float(view * onto_plane(receiver.plane, light));
    for (int k = 0; k < 4; ++k) push.plane[k] = static_cast<float>(side * receiver.plane[k]);
    push.lowest = static_cast<float>(lowest * double{c.frame->geometry.bounds.diagonal()});
    push.highest = light.w == 0 ? 0.0f : static_cast<float>(std::abs(above) * highest);
    const gpu::GraphicsPipeline& pipeline = mark_[i - first];
    commands.bind(pipeline);
    commands.push(pipeline, &push, sizeof push);
    commands.draw_indexed(indices_, index_count_);
  }
  commands.end_rendering();
}

void Projector::run(const RenderInput& in, const Receiver& receiver, gpu::PassRecorder& passes) {
  ensure(in, passes);
  const Case& c = *in.scene_case;
  const ViewSamples& view = *in.view_samples;
  GatherPush p{};
  p.emission = light_emission(c.frame->light).emission;
  p.triangle = view.triangle().address(), p.on_receiver = on_receiver_.address();
  p.position = view.position().address(), p.normal = view.geometric_normal().address();
  p.stencil = stencil_.address(), p.points = points_.address(), p.weights = weights_.address();
  p.visibility = in.device.visibility->address(), p.mask = in.device.mask->address();
  p.pixels = static_cast<uint32_t>(view.width()) * static_cast<uint32_t>(view.height());
  p.words = static_cast<uint32_t>(c.light_samples->mask_words());
  p.count = static_cast<uint32_t>(c.light_samples->count());
  for (int first = 0; first < c.light_samples->count(); first += batch) {
    passes.device_pass("flatten", [&](gpu::Commands& commands) { flatten(commands, in, receiver, first); });
    p.first = static_cast<uint32_t>(first);
    passes.device_pass("gather", [&](gpu::Commands& commands) {
      commands.copy_image_to_buffer(image_, stencil_, VK_IMAGE_ASPECT_STENCIL_BIT);
      commands.barrier();
      commands.dispatch(gather_, p, (p.pixels + group - 1) / group);
    });
  }
}

uint64_t Projector::bytes() const {
  return image_.bytes() + indices_.bytes() + on_receiver_.bytes() + stencil_.bytes() + points_.bytes() +
         weights_.bytes();
}

}  // namespace penumbra::planar_shadow
