#include "techniques/stencil_shadow_volume/stencil_pass.h"

#include "shaders/shadow_volume_resolve.h"
#include "shaders/shadow_volume_volume.h"

namespace penumbra::shadow_volume {
namespace {

constexpr uint32_t group = 64;

VkStencilOpState counting(VkStencilOp pass, VkStencilOp depth_fail) {
  VkStencilOpState s{};
  s.failOp = VK_STENCIL_OP_KEEP, s.passOp = pass, s.depthFailOp = depth_fail;
  s.compareOp = VK_COMPARE_OP_ALWAYS, s.compareMask = s.writeMask = 0xff;
  return s;
}

// Both sides of all faces in one draw. A face counts as nearer than the view sample only where it is
// strictly: the near cap that a view sample lies on has the same depth, and is to count as behind it, so that
// the lit side of a surface is outside the volume that begins there.
gpu::GraphicsPipeline make(gpu::Device& device, const Counting& c, bool depth_test, bool depth_clamp) {
  gpu::GraphicsDesc desc;
  desc.vertex = shadow_volume_volume_spv;
  desc.push_bytes = sizeof(VolumePush);
  desc.depth_format = stencil_format;
  desc.depth_test = depth_test, desc.depth_clamp = depth_clamp;
  desc.depth_compare = VK_COMPARE_OP_GREATER;
  desc.stencil_test = true, desc.stencil_front = c.front, desc.stencil_back = c.back;
  return gpu::GraphicsPipeline(device, desc);
}

}  // namespace

bool stencil_supported(gpu::Device& device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical(), stencil_format, &properties);
  constexpr VkFormatFeatureFlags needed = VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                          VK_FORMAT_FEATURE_TRANSFER_SRC_BIT |
                                          VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
  return (properties.optimalTilingFeatures & needed) == needed;
}

void StencilPass::setup(gpu::Device& device) {
  constexpr VkStencilOp keep = VK_STENCIL_OP_KEEP, up = VK_STENCIL_OP_INCREMENT_AND_WRAP,
                        down = VK_STENCIL_OP_DECREMENT_AND_WRAP;
  const Counting enter{counting(up, keep),
                       counting(down, keep)};  // in front: front faces enter, back faces leave
  const Counting leave{counting(keep, down), counting(keep, up)};  // behind: the other way round
  // z-pass counts from the near plane, which therefore clips; z-fail counts from infinity, and is held there
  // by clamping.
  pass_ = make(device, enter, true, false);
  fail_ = make(device, leave, true, true);
  // Near caps are clipped as the surfaces that they lie on were: a triangle that the near plane cuts has
  // other depths where it is clamped.
  cap_front_ = make(device, leave, true, false);
  cap_back_ = make(device, leave.flipped(), true, false);
  near_ = make(device, {counting(up, keep), counting(up, keep)}, false, false);
  resolve_ = gpu::ComputePipeline(device, shadow_volume_resolve_spv, sizeof(ResolvePush));
}

void StencilPass::ensure(const RenderInput& in, gpu::PassRecorder& passes) {
  const auto width = static_cast<uint32_t>(in.view_samples->width()),
             height = static_cast<uint32_t>(in.view_samples->height());
  if (image_ && image_.desc().width == width && image_.desc().height == height) return;
  gpu::Device& device = *in.scene_case->device;
  gpu::ImageDesc desc;
  desc.width = width, desc.height = height, desc.format = stencil_format;
  desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
               VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  image_ = gpu::Image(device, desc, "shadow volumes: depth and stencil");
  const std::size_t pixels = std::size_t{width} * height;
  gpu::ensure(depth_, device, pixels * sizeof(float), gpu::Memory::device, "shadow volumes: depth");
  gpu::ensure(stencil_, device, (pixels + 3) / 4 * 4, gpu::Memory::device, "shadow volumes: stencil");
  passes.device_pass("depth_copy", [&](gpu::Commands& commands) { commands.initialise(image_); });
}

void StencilPass::draw(gpu::Commands& commands, const Volumes& volumes, Variant variant, const Camera& camera,
                       int width, int height, const std::optional<Mat4d>& near_plane) const {
  const auto w = static_cast<uint32_t>(width), h = static_cast<uint32_t>(height);
  gpu::RenderTarget target{.view = image_.view(), .load = VK_ATTACHMENT_LOAD_OP_LOAD};
  commands.begin_rendering(w, h, {}, &target, stencil_format);
  commands.clear_stencil(0, w, h);
  const auto draw_lists = [&](const gpu::GraphicsPipeline& pipeline, const Mat4d& clip_from_world,
                              std::initializer_list<uint32_t> lists) {
    commands.bind(pipeline);
    const VolumePush push = volumes.push(clip_from_world);
    commands.push(pipeline, &push, sizeof push);
    for (uint32_t list : lists) volumes.draw(commands, list);
  };
  const Mat4d view = camera.clip_from_world(width, height);
  if (near_plane) draw_lists(near_, *near_plane, {LIST_NEAR_FRONT, LIST_NEAR_BACK});
  if (variant == Variant::z_fail) {
    draw_lists(fail_, view, {LIST_SIDES, LIST_FAR});
    draw_lists(cap_front_, view, {LIST_NEAR_FRONT});
    draw_lists(cap_back_, view, {LIST_NEAR_BACK});
  } else {
    draw_lists(pass_, view, {LIST_SIDES});
  }
  commands.end_rendering();
}

void StencilPass::run(const RenderInput& in, const Volumes& volumes, Variant variant,
                      const std::optional<Mat4d>& near_plane, gpu::PassRecorder& passes) {
  ensure(in, passes);
  const ViewSamples& view = *in.view_samples;
  passes.device_pass("depth_copy", [&](gpu::Commands& commands) {
    commands.copy_image_to_buffer(view.depth(), depth_, VK_IMAGE_ASPECT_DEPTH_BIT);
    commands.barrier();
    commands.copy_buffer_to_image(depth_, image_, VK_IMAGE_ASPECT_DEPTH_BIT);
  });
  const Frame& frame = *in.scene_case->frame;
  passes.device_pass("volumes", [&](gpu::Commands& commands) {
    draw(commands, volumes, variant, frame.camera, view.width(), view.height(), near_plane);
  });
  const LightEmission light = light_emission(frame.light);
  ResolvePush p{};
  p.light = light.towards, p.emission = light.emission;
  p.position = view.position().address(), p.normal = view.geometric_normal().address();
  p.stencil = stencil_.address(), p.visibility = in.device.visibility->address();
  p.count = static_cast<uint32_t>(view.width()) * static_cast<uint32_t>(view.height());
  passes.device_pass("resolve", [&](gpu::Commands& commands) {
    commands.copy_image_to_buffer(image_, stencil_, VK_IMAGE_ASPECT_STENCIL_BIT);
    commands.barrier();
    commands.dispatch(resolve_, p, (p.count + group - 1) / group);
  });
}

}  // namespace penumbra::shadow_volume
