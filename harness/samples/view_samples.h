// View samples: for each pixel the first visible surface point through its centre. Made once per frame by a
// raster pass (triangle index) and a compute pass (the point), the only place where positions and normals are
// made; every technique receives the same ones, on the device and mirrored for the host.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/buffer.h"
#include "gpu/pass_recorder.h"
#include "scene/scene.h"

namespace penumbra {

inline constexpr uint32_t no_triangle = 0xffffffffU;

// P' = P + eps * Ng, eps = relative_offset times the diagonal of the scene's bounds.
inline constexpr float relative_offset = 6e-6f;

// Geometry as the device sees it: tightly packed, usable as vertex and index buffers and by address.
struct GeometryOnDevice {
  gpu::Buffer positions;  // 3 floats per vertex
  gpu::Buffer normals;    // 3 floats per vertex
  gpu::Buffer indices;    // uint32, 3 per triangle
  uint32_t vertex_count = 0, triangle_count = 0;
  // Uploads what `frame.changes` says is new, as the pass "upload_geometry". Allocates only on a topology
  // change.
  void update(gpu::Device& device, const Frame& frame, gpu::PassRecorder& passes);
};

// One entry per pixel, row-major, row 0 on top. Where triangle == no_triangle the rest is zero.
struct ViewSamplesHost {
  int width = 0, height = 0;
  std::span<const uint32_t> triangle;
  std::span<const Vec2f> barycentrics;  // weights of corners 1 and 2
  std::span<const Vec4f> position;      // P; w = view depth along the camera's forward axis
  std::span<const Vec4f> origin;  // P' (see relative_offset); w = 1 where there is a view sample, else 0
  std::span<const Vec4f> geometric_normal;  // Ng, unit, towards the viewer
  std::span<const Vec4f> shading_normal;    // Ns, unit, in Ng's half-space
  std::size_t pixel_count() const { return triangle.size(); }
};

class ViewSamples {
 public:
  // Throws PointError when the device cannot hold them (message says how many bytes).
  ViewSamples(gpu::Device& device, int width, int height);
  ~ViewSamples();

  // Passes "view_samples_raster", "view_samples_points", "view_samples_read_back".
  void render(const Frame& frame, const GeometryOnDevice& geometry, gpu::PassRecorder& passes);

  int width() const;
  int height() const;
  const ViewSamplesHost& host() const;

  // Device arrays, same layout as the host's.
  const gpu::Buffer& triangle() const;
  const gpu::Buffer& barycentrics() const;
  const gpu::Buffer& position() const;
  const gpu::Buffer& origin() const;
  const gpu::Buffer& geometric_normal() const;
  const gpu::Buffer& shading_normal() const;
  // D32_SFLOAT, reversed infinite depth (Camera::clip_from_world), in GENERAL layout after render().
  const gpu::Image& depth() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace penumbra
