#include "techniques/stencil_shadow_volume/stencil_pass.h"

#include <array>

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
gpu::GraphicsPipeline make(gpu::Device& device, const Counting& c, bool depth_test, bool depth_clamp,
                           bool depth_bias = false) {
  gpu::GraphicsDesc desc;
  desc.vertex = shadow_volume_volume_spv;
  desc.push_bytes = sizeof(VolumePush);
  desc.depth_format = stencil_format;
  desc.depth_test = depth_test, desc.depth_clamp = depth_clamp;
  desc.depth_compare = VK_COMPARE_OP_GREATER;
  desc.depth_bias = depth_bias;
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
  pass_ = make(device, enter, true, false, true);
  fail_ = make(device, leave, true, true, true);
  // Near caps are clipped as the surfaces that they lie on were: a triangle that the near plane cuts has
  // other depths where it is clamped.
  cap_front_ = make(device, leave, true, false);
  cap_back_ = make(device, leave.flipped(), true, false);
  near_ = make(device, {counting(up, keep), counting(up, keep)}, false, false);
  const std::array<gpu::Specialization, 1> wide{{{0, VK_TRUE}}};
  resolve_ = gpu::ComputePipeline(device, shadow_volume_resolve_spv, sizeof(ResolvePush));
  resolve_wide_ = gpu::ComputePipeline(device, shadow_volume_resolve_spv, sizeof(ResolvePush), wide);
  if (FragmentCounts::supported(device)) wide_.setup(device);
}

void StencilPass::ensure(const RenderInput& in, bool wide, gpu::PassRecorder& passes) {
  const auto width = static_cast<uint32_t>(in.view_samples->width()),
             height = static_cast<uint32_t>(in.view_samples->height());
  gpu::Device& device = *in.scene_case->device;
  const std::size_t pixels = std::size_t{width} * height;
  gpu::ensure(counts_, device, wide ? pixels * sizeof(float) : (pixels + 3) / 4 * 4, gpu::Memory::device,
              "shadow volumes: counts");
  const auto initialise = [&](const gpu::Image& image) {
    passes.device_pass("depth_copy", [&](gpu::Commands& commands) { commands.initialise(image); });
  };
  if (!image_ || image_.desc().width != width || image_.desc().height != height) {
    gpu::ImageDesc desc;
    desc.width = width, desc.height = height, desc.format = stencil_format;
    desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    image_ = gpu::Image(device, desc, "shadow volumes: depth and stencil");
    gpu::ensure(depth_, device, pixels * sizeof(float), gpu::Memory::device, "shadow volumes: depth");
    initialise(image_);
  }
  if (wide && wide_.ensure(device, image_)) initialise(wide_.image());
}

void StencilPass::draw(gpu::Commands& commands, const Volumes& volumes, Variant variant, const Mat4d& view,
                       const std::optional<Mat4d>& near_plane) const {
  const uint32_t w = image_.desc().width, h = image_.desc().height;
  gpu::RenderTarget target{.view = image_.view(), .load = VK_ATTACHMENT_LOAD_OP_LOAD};
  commands.begin_rendering(w, h, {}, &target, stencil_format);
  commands.clear_stencil(0, w, h);
  if (near_plane) volumes.draw(commands, near_, *near_plane, {LIST_NEAR_FRONT, LIST_NEAR_BACK});
  if (variant == Variant::z_fail) {
    volumes.draw(commands, fail_, view, {LIST_SIDES, LIST_FAR}, side_slope_bias);
    volumes.draw(commands, cap_front_, view, {LIST_NEAR_FRONT});
    volumes.draw(commands, cap_back_, view, {LIST_NEAR_BACK});
  } else {
    volumes.draw(commands, pass_, view, {LIST_SIDES}, side_slope_bias);
  }
  commands.end_rendering();
}

void StencilPass::resolve(const RenderInput& in, const LightEmission& light, bool wide, const gpu::Buffer& to,
                          gpu::PassRecorder& passes) const {
  const ViewSamples& view = *in.view_samples;
  ResolvePush p{};
  p.light = light.towards, p.emission = light.emission;
  p.position = view.position().address(), p.normal = view.geometric_normal().address();
  p.counts = counts_.address(), p.visibility = to.address();
  p.count = static_cast<uint32_t>(view.width()) * static_cast<uint32_t>(view.height());
  passes.device_pass("resolve", [&](gpu::Commands& commands) {
    if (wide)
      commands.copy_image_to_buffer(wide_.image(), counts_, VK_IMAGE_ASPECT_COLOR_BIT);
    else
      commands.copy_image_to_buffer(image_, counts_, VK_IMAGE_ASPECT_STENCIL_BIT);
    commands.barrier();
    commands.dispatch(wide ? resolve_wide_ : resolve_, p, (p.count + group - 1) / group);
  });
}

void StencilPass::run(const RenderInput& in, const Volumes& volumes, Variant variant,
                      const std::optional<Mat4d>& near_plane, bool wide, const gpu::Buffer& to,
                      gpu::PassRecorder& passes) {
  ensure(in, wide, passes);
  const ViewSamples& view = *in.view_samples;
  passes.device_pass("depth_copy", [&](gpu::Commands& commands) {
    commands.copy_image_to_buffer(view.depth(), depth_, VK_IMAGE_ASPECT_DEPTH_BIT);
    commands.barrier();
    commands.copy_buffer_to_image(depth_, image_, VK_IMAGE_ASPECT_DEPTH_BIT);
  });
  const Mat4d clip_from_world = in.scene_case->frame->camera.clip_from_world(view.width(), view.height());
  passes.device_pass("volumes", [&](gpu::Commands& commands) {
    if (wide)
      wide_.volumes(commands, volumes, image_, variant, clip_from_world, near_plane);
    else
      draw(commands, volumes, variant, clip_from_world, near_plane);
  });
  resolve(in, volumes.light(), wide, to, passes);
}

}  // namespace penumbra::shadow_volume
