#include "techniques/alias_free_shadow_map/casters.h"

#include <algorithm>
#include <array>

#include "shaders/alias_free_box_fronts.h"
#include "shaders/alias_free_face_light.h"
#include "shaders/alias_free_gather_corners.h"
#include "techniques/alias_free_shadow_map/light_view.h"

namespace penumbra::alias_free {
namespace {

uint64_t groups_of(uint64_t invocations) { return (invocations + group_lanes - 1) / group_lanes; }

}  // namespace

void Casters::setup(const Case& c) {
  gpu::Device& device = *c.device;
  const gpu::Specialization constants[] = {{3, at_infinity(c.frame->light)}};
  const gpu::ImageUse uses[] = {gpu::ImageUse::sampled_nearest};
  gather_ = gpu::ComputePipeline(device, alias_free_gather_corners_spv, sizeof(CornersPush));
  face_ = gpu::ComputePipeline(device, alias_free_face_light_spv, sizeof(FacingPush), constants, uses);
  box_ = gpu::ComputePipeline(device, alias_free_box_fronts_spv, sizeof(FacingPush), constants, uses);
  counts_device_ = gpu::Buffer(device, sizeof counts_, gpu::Memory::device, "counts of casters");
  counts_host_ = gpu::Buffer(device, sizeof counts_, gpu::Memory::read_back, "counts of casters");
}

void Casters::build(const Case& c, gpu::PassRecorder& passes) {
  const Changes& changes = c.frame->changes;
  const bool topology = changes.topology || !built_;
  if (topology) build_topology(c, passes);
  if (topology || changes.positions) gather(c, passes);
  if (topology || changes.positions || changes.light) face_light(c, passes);
  built_ = true;
}

void Casters::build_topology(const Case& c, gpu::PassRecorder& passes) {
  const Geometry& g = c.frame->geometry;
  triangle_count_ = static_cast<uint32_t>(g.triangle_count());
  std::vector<uint32_t> bits((g.triangle_count() + 31) / 32 + 1, 0U);
  for (std::size_t t = 0; t < g.triangle_count(); ++t)
    if (g.in_closed_mesh(t)) bits[t / 32] |= 1U << (t % 32);
  const std::size_t triangles = std::max(triangle_count_, 1U);
  const auto ensure = [&](gpu::Buffer& buffer, std::size_t bytes, const char* what) {
    gpu::ensure(buffer, *c.device, bytes, gpu::Memory::device, what);
  };
  ensure(closed_, bits.size() * 4, "closed meshes' triangles");
  ensure(corners_, triangles * 3 * sizeof(Vec4f), "corners of the triangles");
  ensure(list_, triangles * 4, "triangles that cast");
  ensure(away_, triangles * 4, "triangles turned away");
  ensure(boxes_, (triangles + front_block - 1) / front_block * 2 * sizeof(Vec4f), "boxes of the triangles");
  corner_texels_.ensure(*c.device, passes, triangles * 3, "corners of the triangles");
  gpu::upload(passes, "upload_closed", closed_, bits.data(), bits.size() * 4);
  for (gpu::ComputePipeline* p : {&face_, &box_}) p->bind_images(std::array{corner_texels_.view()});
}

void Casters::gather(const Case& c, gpu::PassRecorder& passes) {
  CornersPush pc{};
  pc.positions = c.geometry->positions.address(), pc.indices = c.geometry->indices.address();
  pc.closed = closed_.address(), pc.corners = corners_.address(), pc.count = triangle_count_;
  passes.device_pass("gather_corners", [&](gpu::Commands& commands) {
    commands.dispatch(gather_, pc, groups_of(triangle_count_));
    commands.barrier();
    corner_texels_.copy_from(commands, corners_, 3 * std::size_t{triangle_count_});
  });
}

void Casters::face_light(const Case& c, gpu::PassRecorder& passes) {
  FacingPush pc{};
  pc.light = light_point(c.frame->light).device_towards();
  pc.away = away_.address(), pc.casters = list_.address(), pc.counts = counts_device_.address();
  pc.boxes = boxes_.address();
  pc.count = triangle_count_, pc.both_faces = params_.casters == CasterFaces::both;
  passes.device_pass("face_light", [&](gpu::Commands& commands) {
    commands.fill(counts_device_, 0);
    commands.barrier();
    commands.dispatch(face_, pc, groups_of((pc.count + triangles_per_lane - 1) / triangles_per_lane));
    commands.barrier();
    commands.dispatch(box_, pc, groups_of((pc.count + front_block - 1) / front_block));
    commands.copy(counts_device_, counts_host_, sizeof counts_);
  });
  passes.finish();
  std::copy_n(counts_host_.view<uint32_t>().begin(), 2, counts_);
}

uint64_t Casters::bytes() const {
  return closed_.bytes() + corners_.bytes() + list_.bytes() + away_.bytes() + boxes_.bytes() +
         counts_device_.bytes() + counts_host_.bytes() + corner_texels_.bytes();
}

}  // namespace penumbra::alias_free
