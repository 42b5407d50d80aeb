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
constexpr int batch = 8;                                           // light samples per stencil
constexpr int word = 32;                                           // light samples per word of a mask
constexpr std::size_t most_stencil_bytes = std::size_t{64} << 20;  // gathered at once
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

// Of one stencil, a byte per pixel.
std::size_t slice_bytes(uint32_t width, uint32_t height) { return (std::size_t{width} * height + 3) / 4 * 4; }

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
  const std::array<gpu::Specialization, 1> each{{{0, VK_TRUE}}};
  gather_ = gpu::ComputePipeline(device, planar_shadow_gather_spv, sizeof(GatherPush));
  gather_each_ = gpu::ComputePipeline(device, planar_shadow_gather_spv, sizeof(GatherPush), each);
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
  const auto send = [&](gpu::Buffer& buffer, const auto& values) {
    const std::size_t bytes = values.size() * sizeof(values[0]);
    gpu::ensure(buffer, device, bytes, gpu::Memory::device, "planar shadow: light");
    gpu::upload(passes, "upload_light", buffer, values.data(), bytes);
  };
  send(points_, light.points);
  send(weights_, light.weights);
  send(dark_, dark_words_);
  const auto width = static_cast<uint32_t>(in.view_samples->width()),
             height = static_cast<uint32_t>(in.view_samples->height());
  const int batches = (light.count() + batch - 1) / batch, to_word = word / batch;
  const std::size_t slice = slice_bytes(width, height);
  const auto fit = static_cast<int>(most_stencil_bytes / slice) / to_word * to_word;
  slices_ = std::min(batches, std::max(fit, to_word));
  gpu::ensure(stencil_, device, slice * static_cast<std::size_t>(slices_), gpu::Memory::device,
              "planar shadow: stencils");
  if (image_ && image_.desc().width == width && image_.desc().height == height) return;
  gpu::ImageDesc desc;
  desc.width = width, desc.height = height, desc.format = stencil_format;
  desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  image_ = gpu::Image(device, desc, "planar shadow: stencil");
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

void Projector::gather(const RenderInput& in, int first, int end, gpu::PassRecorder& passes) const {
  const Case& c = *in.scene_case;
  const ViewSamples& view = *in.view_samples;
  GatherPush p{};
  p.emission = light_emission(c.frame->light).emission;
  p.triangle = view.triangle().address(), p.on_receiver = on_receiver_.address();
  p.position = view.position().address(), p.normal = view.geometric_normal().address();
  p.stencil = stencil_.address(), p.points = points_.address(), p.weights = weights_.address();
  p.dark = dark_.address();
  p.visibility = in.device.visibility->address(), p.mask = in.device.mask->address();
  p.weight = c.light_samples->uniform_weights ? c.light_samples->weights.front() : 0.0f;
  p.pixels = static_cast<uint32_t>(view.width()) * static_cast<uint32_t>(view.height());
  p.words = static_cast<uint32_t>(c.light_samples->mask_words());
  p.first = static_cast<uint32_t>(first), p.end = static_cast<uint32_t>(end);
  passes.device_pass("gather", [&](gpu::Commands& commands) {
    commands.dispatch(each_pixel_ ? gather_each_ : gather_, p, (p.pixels / 4 + group) / group);
  });
}

void Projector::run(const RenderInput& in, const Receiver& receiver, gpu::PassRecorder& passes) {
  const Case& c = *in.scene_case;
  each_pixel_ = !same_horizon(receiver, *c.light_samples, light_emission(c.frame->light).emission,
                              Vec3d(c.frame->camera.eye), dark_words_);
  ensure(in, passes);
  const int count = c.light_samples->count();
  const std::size_t slice = slice_bytes(image_.desc().width, image_.desc().height);
  for (int begin = 0; begin < count; begin += slices_ * batch) {
    const int end = std::min(begin + slices_ * batch, count);
    for (int first = begin; first < end; first += batch)
      passes.device_pass("flatten", [&](gpu::Commands& commands) {
        flatten(commands, in, receiver, first);
        commands.barrier();
        commands.copy_image_to_buffer(image_, stencil_, VK_IMAGE_ASPECT_STENCIL_BIT, 0,
                                      slice * static_cast<std::size_t>((first - begin) / batch));
      });
    gather(in, begin, end, passes);
  }
}

uint64_t Projector::bytes() const {
  return image_.bytes() + indices_.bytes() + on_receiver_.bytes() + stencil_.bytes() + points_.bytes() +
         weights_.bytes() + dark_.bytes() + dark_words_.capacity() * sizeof(uint32_t);
}

}  // namespace penumbra::planar_shadow
