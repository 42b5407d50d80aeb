#include "techniques/soft_shadow_volume/wedge_pass.h"

#include <array>

#include "shaders/soft_shadow_volume_classify.h"
#include "shaders/soft_shadow_volume_near_cap_frag.h"
#include "shaders/soft_shadow_volume_near_cap_vert.h"
#include "shaders/soft_shadow_volume_resolve.h"
#include "shaders/soft_shadow_volume_side_frag.h"
#include "shaders/soft_shadow_volume_side_vert.h"
#include "shaders/soft_shadow_volume_wedge_frag.h"
#include "shaders/soft_shadow_volume_wedge_vert.h"
#include "shaders/soft_shadow_volume_wedges.h"

namespace penumbra::soft_shadow_volume {
namespace {

constexpr uint32_t group = 64;
uint64_t groups(uint32_t count) { return (uint64_t{count} + group - 1) / group; }

uint32_t pixels(const RenderInput& in) {
  return static_cast<uint32_t>(in.view_samples->width()) * static_cast<uint32_t>(in.view_samples->height());
}

gpu::Image image(const RenderInput& in, VkFormat format, VkImageUsageFlags usage, const char* what) {
  gpu::ImageDesc desc;
  desc.width = static_cast<uint32_t>(in.view_samples->width());
  desc.height = static_cast<uint32_t>(in.view_samples->height());
  desc.format = format, desc.usage = usage;
  return gpu::Image(*in.scene_case->device, desc, what);
}

gpu::GraphicsDesc adding(gpu::Spirv vertex, gpu::Spirv fragment, uint32_t push_bytes) {
  gpu::GraphicsDesc desc;
  desc.vertex = vertex, desc.fragment = fragment, desc.push_bytes = push_bytes;
  desc.color_formats = {sum_format}, desc.blend_add = true;
  return desc;
}

// No plane cuts what is near the eye: depth is clamped.
gpu::GraphicsPipeline volume_pipeline(gpu::Device& device, gpu::Spirv vertex, gpu::Spirv fragment) {
  gpu::GraphicsDesc desc = adding(vertex, fragment, sizeof(DrawPush));
  desc.images = {gpu::ImageUse::sampled_nearest};
  desc.write_mask = VK_COLOR_COMPONENT_R_BIT, desc.depth_clamp = true;
  return gpu::GraphicsPipeline(device, desc);
}

// Drawn where the far side of a wedge is behind the view sample.
gpu::GraphicsPipeline wedge_pipeline(gpu::Device& device, uint32_t shape, bool table, bool horizon,
                                     bool counting) {
  gpu::GraphicsDesc desc =
      adding(soft_shadow_volume_wedge_vert_spv, soft_shadow_volume_wedge_frag_spv, sizeof(WedgePush));
  desc.constants = {{0, shape}, {1, table ? 1U : 0U}, {2, counting ? 1U : 0U}, {3, horizon ? 1U : 0U}};
  desc.images.assign(5, gpu::ImageUse::sampled_nearest);
  desc.depth_format = VK_FORMAT_D32_SFLOAT, desc.depth_test = desc.depth_clamp = true;
  desc.depth_compare = VK_COMPARE_OP_LESS_OR_EQUAL, desc.cull = VK_CULL_MODE_BACK_BIT;
  if (!counting) desc.write_mask = VK_COLOR_COMPONENT_G_BIT;
  return gpu::GraphicsPipeline(device, desc);
}

// A little more than the scene takes up: nothing is seen beyond.
Box bounds_of(const RenderInput& in) {
  Box b = in.scene_case->frame->geometry.bounds;
  const float pad = 1e-4f * b.diagonal();
  b.lo = b.lo - Vec3f{pad, pad, pad}, b.hi = b.hi + Vec3f{pad, pad, pad};
  return b;
}

// The side of the bounds opposite the light, if it is outside: every ray from it through the scene ends
// there.
void end_sides(const Box& bounds, DrawPush& p) {
  float farthest = 0;
  p.center.w = -1;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool above : {false, true}) {
      const float beyond = above ? p.center[axis] - bounds.hi[axis] : bounds.lo[axis] - p.center[axis];
      if (beyond <= farthest) continue;
      farthest = beyond, p.center.w = static_cast<float>(axis);
      p.end = above ? bounds.lo[axis] : bounds.hi[axis];
    }
}

}  // namespace

bool sums_supported(gpu::Device& device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical(), sum_format, &properties);
  return properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
}

void WedgePass::setup(gpu::Device& device, uint32_t shape, gpu::PassRecorder& passes) {
  shape_ = shape;
  const bool table = params_.coverage == Coverage::table;
  tables_.make(device, passes, shape, table ? params_.table_size : 0);
  const gpu::Specialization of_shape[] = {{0, shape}};
  const gpu::ImageUse texture[] = {gpu::ImageUse::sampled_nearest};
  wedge_pipeline_ = gpu::ComputePipeline(device, soft_shadow_volume_wedges_spv, sizeof(WedgesPush), of_shape);
  resolve_pipeline_ =
      gpu::ComputePipeline(device, soft_shadow_volume_resolve_spv, sizeof(ResolvePush), of_shape, texture);
  sides_ = volume_pipeline(device, soft_shadow_volume_side_vert_spv, soft_shadow_volume_side_frag_spv);
  near_caps_ =
      volume_pipeline(device, soft_shadow_volume_near_cap_vert_spv, soft_shadow_volume_near_cap_frag_spv);
  classify_pipeline_ =
      gpu::ComputePipeline(device, soft_shadow_volume_classify_spv, sizeof(ClassifyPush), of_shape);
  for (const bool horizon : {false, true}) {
    coverage_[horizon] = wedge_pipeline(device, shape, table, horizon, false);
    counting_[horizon] = wedge_pipeline(device, shape, false, horizon, true);
  }
}

void WedgePass::set_light(gpu::Device& device, const Light& light, gpu::PassRecorder& passes) {
  const LightTexture t = texture_of(light, params_.split);
  const bool fits = texture_ && texture_.desc().width == t.width && texture_.desc().height == t.height;
  if (!fits) {
    gpu::ImageDesc desc;
    desc.width = t.width, desc.height = t.height, desc.format = VK_FORMAT_R32G32B32A32_SFLOAT;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    texture_ = gpu::Image(device, desc, "soft shadow volumes: light texture");
    texels_ = gpu::Buffer(device, t.texels.size() * sizeof(Vec4f), gpu::Memory::device,
                          "soft shadow volumes: light texture");
    sums_ = {};  // descriptors are written with the images of a picture's size
  }
  gpu::upload(passes, "upload_texture", texels_, t.texels.data(), t.texels.size() * sizeof(Vec4f));
  passes.device_pass("upload_texture", [&](gpu::Commands& commands) {
    if (!fits) commands.initialise(texture_);
    commands.barrier();
    commands.copy_buffer_to_image(texels_, texture_, VK_IMAGE_ASPECT_COLOR_BIT);
  });
  passes.finish();  // the array that it copies from ends here
}

void WedgePass::ensure(const RenderInput& in, gpu::PassRecorder& passes) {
  if (sums_ && sums_.desc().width == static_cast<uint32_t>(in.view_samples->width()) &&
      sums_.desc().height == static_cast<uint32_t>(in.view_samples->height()))
    return;
  constexpr VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  constexpr VkImageUsageFlags depth =
      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  constexpr VkFormat four = VK_FORMAT_R32G32B32A32_SFLOAT;
  position_ = image(in, four, read, "soft shadow volumes: positions");
  normal_ = image(in, four, read, "soft shadow volumes: normals");
  sums_ = image(in, sum_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                "soft shadow volumes: sums");
  const auto buffer = [&](std::size_t bytes, const char* what) {
    return gpu::Buffer(*in.scene_case->device, pixels(in) * bytes, gpu::Memory::device, what);
  };
  sum_buffer_ = buffer(sizeof(Vec2f), "soft shadow volumes: sums");
  classed_ = buffer(sizeof(Vec4f), "soft shadow volumes: classes of view samples");
  const std::array views{position_.view(), normal_.view(), tables_.angles(), tables_.areas(),
                         texture_.view()};
  for (const int k : {0, 1}) {
    depth_[k] = image(in, VK_FORMAT_D32_SFLOAT, depth, "soft shadow volumes: depth of a class");
    depth_buffer_[k] = buffer(sizeof(float), "soft shadow volumes: depth of a class");
    coverage_[k].bind_images(views), counting_[k].bind_images(views);
  }
  resolve_pipeline_.bind_images(std::span(views).last(1));
  sides_.bind_images(std::span(views).first(1)), near_caps_.bind_images(std::span(views).first(1));
  passes.device_pass("view_copy", [&](gpu::Commands& commands) {
    for (const gpu::Image* i : {&position_, &normal_, &sums_, &depth_[0], &depth_[1]})
      commands.initialise(*i);
  });
}

void WedgePass::begin(const RenderInput& in, gpu::PassRecorder& passes) {
  ensure(in, passes);
  passes.device_pass("view_copy", [&](gpu::Commands& commands) {
    commands.copy_buffer_to_image(in.view_samples->position(), position_, VK_IMAGE_ASPECT_COLOR_BIT);
  });
}

void WedgePass::classify(const RenderInput& in, const Part& part, gpu::PassRecorder& passes) {
  ClassifyPush p{};
  p.light = part.light, p.position = in.view_samples->position().address();
  p.normal = in.view_samples->geometric_normal().address(), p.classed = classed_.address();
  p.depth_whole = depth_buffer_[0].address(), p.depth_cut = depth_buffer_[1].address();
  p.count = pixels(in), p.near_plane = in.scene_case->frame->camera.near_plane;
  passes.device_pass("classify", [&](gpu::Commands& commands) {
    commands.dispatch(classify_pipeline_, p, groups(p.count));
    commands.barrier();
    commands.copy_buffer_to_image(classed_, normal_, VK_IMAGE_ASPECT_COLOR_BIT);
    for (const int k : {0, 1})
      commands.copy_buffer_to_image(depth_buffer_[k], depth_[k], VK_IMAGE_ASPECT_DEPTH_BIT);
  });
}

void WedgePass::make_wedges(const RenderInput& in, const Silhouettes& silhouettes, const Part& part,
                            gpu::PassRecorder& passes) {
  const std::size_t need = std::size_t{silhouettes.count()} * sizeof(Wedge);
  if (!wedges_ || wedges_.bytes() < need)
    gpu::ensure(wedges_, *in.scene_case->device, need + need / 4 + sizeof(Wedge), gpu::Memory::device,
                "soft shadow volumes: wedges");
  WedgesPush p{};
  p.light = part.light, p.positions = in.scene_case->geometry->positions.address();
  const Box bounds = bounds_of(in);
  p.lo = {bounds.lo.x, bounds.lo.y, bounds.lo.z, 0}, p.hi = {bounds.hi.x, bounds.hi.y, bounds.hi.z, 0};
  p.silhouettes = silhouettes.list().address(), p.wedges = wedges_.address();
  const std::size_t index_bytes = std::size_t{silhouettes.count()} * WEDGE_INDICES * sizeof(uint32_t);
  if (!indices_ || indices_.bytes() < index_bytes)
    gpu::ensure(indices_, *in.scene_case->device, index_bytes + index_bytes / 4 + sizeof(Wedge),
                gpu::Memory::device, "soft shadow volumes: triangles of wedges");
  p.indices = indices_.address();
  p.count = silhouettes.count(), p.loose = params_.wedges == WedgeKind::loose ? 1 : 0;
  passes.device_pass("wedges", [&](gpu::Commands& commands) {
    if (p.count > 0) commands.dispatch(wedge_pipeline_, p, groups(p.count));
  });
}

void WedgePass::draw_sides(gpu::Commands& commands, const RenderInput& in, const Silhouettes& silhouettes,
                           const Part& part) const {
  const gpu::RenderTarget color{.view = sums_.view()};
  commands.begin_rendering(sums_.desc().width, sums_.desc().height, std::array{color}, nullptr);
  DrawPush p{};
  p.clip_from_world = to_float(
      in.scene_case->frame->camera.clip_from_world(in.view_samples->width(), in.view_samples->height()));
  p.center = {part.pivot.x, part.pivot.y, part.pivot.z, 0};
  p.positions = in.scene_case->geometry->positions.address();
  p.silhouettes = silhouettes.list().address(), p.caps = silhouettes.extraction().address();
  p.indices = in.scene_case->geometry->indices.address(), p.seen = in.view_samples->triangle().address();
  p.width = sums_.desc().width;
  end_sides(bounds_of(in), p);
  if (silhouettes.count() > 0) {
    commands.bind(sides_);
    commands.push(sides_, &p, sizeof p);
    commands.draw(6 * silhouettes.count());
  }
  if (silhouettes.near_caps() > 0) {
    commands.bind(near_caps_);
    commands.push(near_caps_, &p, sizeof p);
    commands.draw(silhouettes.near_caps());
  }
  commands.end_rendering();
}

void WedgePass::draw_wedges(gpu::Commands& commands, const RenderInput& in, const Silhouettes& silhouettes,
                            const Part& part, bool counting) const {
  WedgePush p{};
  p.clip_from_world = to_float(
      in.scene_case->frame->camera.clip_from_world(in.view_samples->width(), in.view_samples->height()));
  p.pivot = {part.pivot.x, part.pivot.y, part.pivot.z, part.light.center.w};
  p.scale_u = part.light.scale_u, p.scale_v = part.light.scale_v, p.wedges = wedges_.address();
  for (const int k : {0, 1}) {
    const bool clear = counting && k == 0;
    const gpu::RenderTarget color{.view = sums_.view(),
                                  .load = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD};
    const gpu::RenderTarget depth{.view = depth_[k].view(), .load = VK_ATTACHMENT_LOAD_OP_LOAD};
    const gpu::GraphicsPipeline& pipeline = counting ? counting_[k] : coverage_[k];
    commands.begin_rendering(sums_.desc().width, sums_.desc().height, std::array{color}, &depth,
                             VK_FORMAT_D32_SFLOAT);
    if (silhouettes.count() > 0) {
      commands.bind(pipeline);
      commands.push(pipeline, &p, sizeof p);
      commands.draw_indexed(indices_, WEDGE_INDICES * silhouettes.count());
    }
    commands.end_rendering();
    commands.barrier();
  }
}

void WedgePass::resolve(const RenderInput& in, const Silhouettes& silhouettes, const Part& part, bool first,
                        gpu::PassRecorder& passes) const {
  const ViewSamples& view = *in.view_samples;
  ResolvePush p{};
  p.light = part.light, p.position = view.position().address(), p.normal = view.geometric_normal().address();
  p.sums = sum_buffer_.address(), p.visibility = in.device.visibility->address();
  p.extraction = silhouettes.extraction().address();
  p.count = pixels(in), p.first = first ? 1 : 0, p.share = part.share;
  passes.device_pass("resolve", [&](gpu::Commands& commands) {
    commands.copy_image_to_buffer(sums_, sum_buffer_, VK_IMAGE_ASPECT_COLOR_BIT);
    commands.barrier();
    commands.dispatch(resolve_pipeline_, p, groups(p.count));
  });
}

void WedgePass::run(const RenderInput& in, const Silhouettes& silhouettes, const Part& part, bool first,
                    gpu::PassRecorder& passes) {
  const bool soft = shape_ != SHAPE_POINT;
  if (soft) classify(in, part, passes), make_wedges(in, silhouettes, part, passes);
  passes.device_pass("hard_shadow",
                     [&](gpu::Commands& commands) { draw_sides(commands, in, silhouettes, part); });
  if (soft)
    passes.device_pass("coverage",
                       [&](gpu::Commands& commands) { draw_wedges(commands, in, silhouettes, part, false); });
  resolve(in, silhouettes, part, first, passes);
}

WedgePass::Wedges WedgePass::read(const RenderInput& in, const Silhouettes& silhouettes, const Part& part,
                                  gpu::PassRecorder& passes) {
  Wedges drawn{std::vector<Vec2f>(pixels(in)), {}};
  if (shape_ == SHAPE_POINT || silhouettes.count() == 0) return drawn;
  drawn.wedges.resize(silhouettes.count());
  classify(in, part, passes);
  make_wedges(in, silhouettes, part, passes);
  passes.device_pass("coverage", [&](gpu::Commands& commands) {
    draw_wedges(commands, in, silhouettes, part, true);
    commands.barrier();
    commands.copy_image_to_buffer(sums_, sum_buffer_, VK_IMAGE_ASPECT_COLOR_BIT);
  });
  gpu::download(passes, "download", sum_buffer_, drawn.sums.data(), drawn.sums.size() * sizeof(Vec2f));
  gpu::download(passes, "download", wedges_, drawn.wedges.data(), drawn.wedges.size() * sizeof(Wedge));
  passes.finish();
  return drawn;
}

WedgeCounts WedgePass::count(const RenderInput& in, const Silhouettes& silhouettes, const Part& part,
                             gpu::PassRecorder& passes) {
  const Wedges drawn = read(in, silhouettes, part, passes);
  WedgeCounts counts;
  for (const Vec2f& s : drawn.sums) counts.fragments += double(s.x), counts.pixels += double(s.y);
  for (const Wedge& w : drawn.wedges) counts.whole_picture += w.edge[1].w == float(WHOLE_PICTURE);
  return counts;
}

uint64_t WedgePass::bytes() const {
  uint64_t sum = classed_.bytes();
  for (const int k : {0, 1}) sum += depth_[k].bytes() + depth_buffer_[k].bytes();
  return sum + tables_.bytes() + position_.bytes() + normal_.bytes() + sums_.bytes() + sum_buffer_.bytes() +
         texture_.bytes() + texels_.bytes() + wedges_.bytes() + indices_.bytes();
}

}  // namespace penumbra::soft_shadow_volume
