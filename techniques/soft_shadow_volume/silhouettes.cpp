#include "techniques/soft_shadow_volume/silhouettes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "shaders/soft_shadow_volume_silhouettes.h"
#include "shaders/soft_shadow_volume_turned.h"
#include "techniques/soft_shadow_volume/casters.h"

namespace penumbra::soft_shadow_volume {
namespace {

constexpr uint32_t group = 64;
uint64_t groups(uint32_t count) { return (uint64_t{count} + group - 1) / group; }

// From the eye to the farthest corner of the near plane's part of the picture.
float near_reach(const Camera& camera, int width, int height) {
  const Vec3d corner = camera.ray_direction(0, 0, width, height);
  return 1.01f * camera.near_plane * static_cast<float>(length(corner));
}

}  // namespace

void Silhouettes::setup(gpu::Device& device) {
  scan_.setup(device, std::min(device.caps().subgroup_size, 32U));
  turned_pipeline_ = gpu::ComputePipeline(device, soft_shadow_volume_turned_spv, sizeof(ExtractPush));
  const gpu::Specialization mark[] = {{0, 0}}, write[] = {{0, 1}};
  mark_pipeline_ =
      gpu::ComputePipeline(device, soft_shadow_volume_silhouettes_spv, sizeof(ExtractPush), mark);
  write_pipeline_ =
      gpu::ComputePipeline(device, soft_shadow_volume_silhouettes_spv, sizeof(ExtractPush), write);
  read_back_ = gpu::Buffer(device, sizeof(Extraction) + 2 * sizeof(uint32_t), gpu::Memory::read_back,
                           "soft shadow volumes: counts");
}

void Silhouettes::build(const Case& c, gpu::PassRecorder& passes) {
  const Geometry& g = c.frame->geometry;
  const bool anew = edges_.build(c, passes, "soft shadow volumes");
  if (!anew && casts_ && (g.closed || !(c.frame->changes.positions || c.frame->changes.light))) return;
  Casters casters;
  passes.host_pass("casters", [&] {
    if (g.closed)
      casters.casts.assign(g.triangle_count(), 1);
    else
      casters = find_casters(g, edges_.adjacency(), c.frame->light);
  });
  if (!casters.refusal.empty()) throw PointError(casters.refusal);
  const std::size_t triangles = std::max<std::size_t>(g.triangle_count(), 1), words = sizeof(uint32_t);
  const std::size_t edges = std::max<std::size_t>(edges_.count(), 1);
  const auto need = [&](gpu::Buffer& buffer, std::size_t bytes, const char* what) {
    gpu::ensure(buffer, *c.device, bytes, gpu::Memory::device, what);
  };
  need(casts_, triangles * words, "soft shadow volumes: casters");
  need(turned_, triangles * words, "soft shadow volumes: sides of triangles");
  need(extraction_, sizeof(Extraction) + 3 * triangles * words, "soft shadow volumes: near caps");
  need(marks_, edges * words, "soft shadow volumes: marks of edges");
  need(places_, edges * words, "soft shadow volumes: places of edges");
  need(scratch_, scan_.scratch_bytes(edges_.count()), "soft shadow volumes: sums of blocks");
  if (!casters.casts.empty())
    gpu::upload(passes, "upload_adjacency", casts_, casters.casts.data(), casters.casts.size() * words);
  passes.finish();  // the array that it copies from ends here
}

void Silhouettes::extract(const Case& c, const Part& part, gpu::PassRecorder& passes) {
  const Camera& camera = c.frame->camera;
  ExtractPush p{};
  p.light = {part.pivot.x, part.pivot.y, part.pivot.z, near_reach(camera, c.width, c.height)};
  p.eye = {camera.eye.x, camera.eye.y, camera.eye.z, 1};
  p.positions = c.geometry->positions.address(), p.indices = c.geometry->indices.address();
  p.casts = casts_.address(), p.turned = turned_.address();
  p.edges = edges_.edges().address(), p.faces = edges_.faces().address();
  p.marks = marks_.address(), p.places = places_.address(), p.extraction = extraction_.address();
  const Extraction none{};
  passes.device_pass("turned", [&](gpu::Commands& commands) {
    commands.update(extraction_, &none, sizeof none);
    commands.barrier();
    p.count = c.geometry->triangle_count;
    commands.dispatch(turned_pipeline_, p, groups(p.count));
  });
  p.count = edges_.count();
  passes.device_pass("silhouettes", [&](gpu::Commands& commands) {
    commands.dispatch(mark_pipeline_, p, groups(p.count));
    commands.barrier();
    scan_.record(commands, marks_, places_, scratch_, p.count);
    commands.copy(extraction_, read_back_, sizeof(Extraction));
    commands.copy(scratch_, read_back_, 2 * sizeof(uint32_t), 0, sizeof(Extraction));
  });
  read(passes);
  // A quarter more than is needed: frames that follow differ little, and allocate nothing.
  if (list_.bytes() < std::size_t{count_} * sizeof(Silhouette) || !list_)
    gpu::ensure(list_, *c.device, (std::size_t{count_} * 5 / 4 + 1) * sizeof(Silhouette), gpu::Memory::device,
                "soft shadow volumes: silhouettes");
  p.silhouettes = list_.address();
  passes.device_pass("silhouettes", [&](gpu::Commands& commands) {
    commands.dispatch(write_pipeline_, p, groups(p.count));
  });
}

void Silhouettes::read(gpu::PassRecorder& passes) {
  passes.finish();
  const auto* extraction = static_cast<const Extraction*>(read_back_.mapped());
  near_caps_ = extraction->near_caps, eye_volumes_ = extraction->eye_count;
  count_ = static_cast<uint32_t>(PrefixScan::total(reinterpret_cast<const uint32_t*>(extraction + 1)));
}

uint64_t Silhouettes::bytes() const {
  uint64_t sum = edges_.bytes();
  for (const gpu::Buffer* b :
       {&casts_, &turned_, &marks_, &places_, &scratch_, &extraction_, &list_, &read_back_})
    sum += b->bytes();
  return sum;
}

}  // namespace penumbra::soft_shadow_volume
