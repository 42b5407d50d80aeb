#include "samples/view_samples.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "gpu/pipeline.h"
#include "samples/shaders/view_samples_params.h"
#include "shaders/view_samples_comp.h"
#include "shaders/view_samples_frag.h"
#include "shaders/view_samples_vert.h"

namespace penumbra {

void GeometryOnDevice::update(gpu::Device& device, const Frame& frame, gpu::PassRecorder& passes) {
  const Geometry& g = frame.geometry;
  constexpr const char* pass = "upload_geometry";
  if (frame.changes.topology || !positions) {
    gpu::ensure(positions, device, g.positions.size() * sizeof(Vec3f), gpu::Memory::device,
                "vertex positions");
    gpu::ensure(normals, device, g.normals.size() * sizeof(Vec3f), gpu::Memory::device, "vertex normals");
    gpu::ensure(indices, device, g.indices.size() * sizeof(uint32_t), gpu::Memory::device,
                "triangle indices");
    vertex_count = static_cast<uint32_t>(g.positions.size());
    triangle_count = static_cast<uint32_t>(g.triangle_count());
    gpu::upload(passes, pass, indices, g.indices.data(), g.indices.size() * sizeof(uint32_t));
  }
  if (frame.changes.topology || frame.changes.positions) {
    gpu::upload(passes, pass, positions, g.positions.data(), g.positions.size() * sizeof(Vec3f));
    gpu::upload(passes, pass, normals, g.normals.data(), g.normals.size() * sizeof(Vec3f));
  }
}

namespace {

// A device array with its mirror: the mapped memory itself where there is one, else a copy.
template <class T>
struct Mirrored {
  gpu::Buffer buffer;
  std::vector<T> copy;
  Mirrored(gpu::Device& device, std::size_t count, const char* what)
      : buffer(device, count * sizeof(T), gpu::Memory::device, what) {
    if (!buffer.mapped()) copy.resize(count);
  }
  std::span<const T> host(std::size_t count) const {
    return {buffer.mapped() ? static_cast<const T*>(buffer.mapped()) : copy.data(), count};
  }
  void read_back(gpu::PassRecorder& passes, std::string_view pass) {
    if (!copy.empty()) gpu::download(passes, pass, buffer, copy.data(), copy.size() * sizeof(T));
  }
};

gpu::shared::ViewSamplesParams camera_params(const Frame& frame, int width, int height) {
  const Camera& camera = frame.camera;
  const Camera::Basis b = camera.basis();
  gpu::shared::ViewSamplesParams p{};
  const Vec3d corner = camera.ray_direction(0, 0, width, height);
  p.eye = camera.eye;
  p.corner = Vec3f(corner);
  p.step_x = Vec3f((camera.ray_direction(width, 0, width, height) - corner) / double(width));
  p.step_y = Vec3f((camera.ray_direction(0, height, width, height) - corner) / double(height));
  p.forward = Vec3f(b.forward);
  p.offset = relative_offset * frame.geometry.bounds.diagonal();
  p.width = static_cast<uint32_t>(width);
  p.pixels = static_cast<uint32_t>(width) * static_cast<uint32_t>(height);
  return p;
}

}  // namespace

struct ViewSamples::Impl {
  int width, height;
  std::size_t pixels;
  Mirrored<uint32_t> triangle;
  Mirrored<Vec2f> barycentrics;
  Mirrored<Vec4f> position, origin, geometric_normal, shading_normal;
  gpu::Buffer params;
  gpu::Image ids, depth;
  gpu::GraphicsPipeline raster;
  gpu::ComputePipeline points;
  ViewSamplesHost host;

  Impl(gpu::Device& d, int w, int h)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
        triangle(d, pixels, "view samples: triangles"),
        barycentrics(d, pixels, "view samples: barycentrics"),
        position(d, pixels, "view samples: positions"),
        origin(d, pixels, "view samples: origins"),
        geometric_normal(d, pixels, "view samples: geometric normals"),
        shading_normal(d, pixels, "view samples: shading normals"),
        params(d, sizeof(gpu::shared::ViewSamplesParams), gpu::Memory::device, "view samples: parameters"),
        ids(d, image_desc(VK_FORMAT_R32_UINT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT),
            "view samples: triangle image"),
        depth(d, image_desc(VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT),
              "view samples: depth") {
    gpu::GraphicsDesc desc;
    desc.vertex = view_samples_vert_spv, desc.fragment = view_samples_frag_spv;
    desc.push_bytes = sizeof(Mat4f), desc.vertex_strides = {sizeof(Vec3f)};
    desc.color_formats = {VK_FORMAT_R32_UINT}, desc.depth_format = VK_FORMAT_D32_SFLOAT;
    desc.depth_test = desc.depth_write = true;
    raster = gpu::GraphicsPipeline(d, desc);
    points = gpu::ComputePipeline(d, view_samples_comp_spv, sizeof(VkDeviceAddress));
    host = {width,
            height,
            triangle.host(pixels),
            barycentrics.host(pixels),
            position.host(pixels),
            origin.host(pixels),
            geometric_normal.host(pixels),
            shading_normal.host(pixels)};
  }

  gpu::ImageDesc image_desc(VkFormat format, VkImageUsageFlags use) const {
    gpu::ImageDesc desc;
    desc.width = static_cast<uint32_t>(width), desc.height = static_cast<uint32_t>(height),
    desc.format = format;
    desc.usage = use | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    return desc;
  }

  void draw(gpu::Commands& c, const Frame& frame, const GeometryOnDevice& g) const {
    c.initialise(ids);
    c.initialise(depth);
    gpu::RenderTarget color{.view = ids.view()};
    color.clear.color.uint32[0] = no_triangle;
    const gpu::RenderTarget depth_target{.view = depth.view()};  // cleared to 0: reversed depth's infinity
    const auto w = static_cast<uint32_t>(width), h = static_cast<uint32_t>(height);
    c.begin_rendering(w, h, std::array{color}, &depth_target, VK_FORMAT_D32_SFLOAT);
    c.bind(raster);
    const Mat4f clip_from_world = to_float(frame.camera.clip_from_world(width, height));
    c.push(raster, &clip_from_world, sizeof clip_from_world);
    c.vertex_buffers(std::array{g.positions.handle()});
    c.draw_indexed(g.indices, 3 * g.triangle_count);
    c.end_rendering();
    c.barrier();
    c.copy_image_to_buffer(ids, triangle.buffer, VK_IMAGE_ASPECT_COLOR_BIT);
  }

  void make_points(gpu::Commands& c, const Frame& frame, const GeometryOnDevice& g) const {
    gpu::shared::ViewSamplesParams p = camera_params(frame, width, height);
    p.vertex_positions = g.positions.address(), p.vertex_normals = g.normals.address();
    p.indices = g.indices.address(), p.triangle = triangle.buffer.address();
    p.barycentrics = barycentrics.buffer.address(), p.position = position.buffer.address();
    p.origin = origin.buffer.address(), p.geometric_normal = geometric_normal.buffer.address();
    p.shading_normal = shading_normal.buffer.address();
    c.update(params, &p, sizeof p);
    c.barrier();
    c.dispatch(points, params.address(), (pixels + 63) / 64);
  }
};

ViewSamples::ViewSamples(gpu::Device& device, int width, int height) {
  const uint32_t limit = device.caps().max_image_2d;
  if (width < 1 || height < 1 || static_cast<uint32_t>(std::max(width, height)) > limit)
    throw PointError(fmt::format("a picture of {} x {} is outside the device's range of 1 to {} a side",
                                 width, height, limit));
  impl_ = std::make_unique<Impl>(device, width, height);
}

ViewSamples::~ViewSamples() = default;

void ViewSamples::render(const Frame& frame, const GeometryOnDevice& geometry, gpu::PassRecorder& passes) {
  Impl& s = *impl_;
  passes.device_pass("view_samples_raster", [&](gpu::Commands& c) { s.draw(c, frame, geometry); });
  passes.device_pass("view_samples_points", [&](gpu::Commands& c) { s.make_points(c, frame, geometry); });
  constexpr const char* pass = "view_samples_read_back";
  s.triangle.read_back(passes, pass);
  s.barycentrics.read_back(passes, pass);
  s.position.read_back(passes, pass);
  s.origin.read_back(passes, pass);
  s.geometric_normal.read_back(passes, pass);
  s.shading_normal.read_back(passes, pass);
  passes.finish();
}

int ViewSamples::width() const { return impl_->width; }
int ViewSamples::height() const { return impl_->height; }
const ViewSamplesHost& ViewSamples::host() const { return impl_->host; }
const gpu::Buffer& ViewSamples::triangle() const { return impl_->triangle.buffer; }
const gpu::Buffer& ViewSamples::barycentrics() const { return impl_->barycentrics.buffer; }
const gpu::Buffer& ViewSamples::position() const { return impl_->position.buffer; }
const gpu::Buffer& ViewSamples::origin() const { return impl_->origin.buffer; }
const gpu::Buffer& ViewSamples::geometric_normal() const { return impl_->geometric_normal.buffer; }
const gpu::Buffer& ViewSamples::shading_normal() const { return impl_->shading_normal.buffer; }
const gpu::Image& ViewSamples::depth() const { return impl_->depth; }

}  // namespace penumbra
