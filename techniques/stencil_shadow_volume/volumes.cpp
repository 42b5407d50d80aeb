#include "techniques/stencil_shadow_volume/volumes.h"

#include "shaders/shadow_volume_facing.h"
#include "shaders/shadow_volume_silhouettes.h"

namespace penumbra::shadow_volume {
namespace {

constexpr uint32_t group = 64;

bool contains(const Box& box, Vec3f p) { return min(box.lo, p) == box.lo && max(box.hi, p) == box.hi; }

}  // namespace

void Volumes::setup(gpu::Device& device) {
  facing_pipeline_ = gpu::ComputePipeline(device, shadow_volume_facing_spv, sizeof(ExtractPush));
  silhouette_pipeline_ = gpu::ComputePipeline(device, shadow_volume_silhouettes_spv, sizeof(ExtractPush));
  lists_ = gpu::Buffer(device, sizeof(Lists), gpu::Memory::device, "shadow volumes: list addresses");
  draws_ = gpu::Buffer(device, sizeof(Draws), gpu::Memory::device, "shadow volumes: draw arguments");
  draws_read_back_ = gpu::Buffer(device, sizeof(Draws), gpu::Memory::read_back, "shadow volumes: counts");
}

void Volumes::build(const Case& c, gpu::PassRecorder& passes) {
  const uint32_t triangles = c.geometry->triangle_count;
  gpu::ensure(facing_, *c.device, std::max(triangles, 1U) * sizeof(int32_t), gpu::Memory::device,
              "shadow volumes: facings");
  if (params_.extrusion == Extrusion::per_triangle) return;
  edges_.build(c, passes, "shadow volumes");
}

// Every list can hold the most that any light could ask for: nothing is ever cut off.
void Volumes::allocate(const Case& c, bool caps, bool far_caps) {
  const std::size_t triangle_bytes =
      3 * sizeof(uint32_t) * std::max<std::size_t>(c.geometry->triangle_count, 1);
  const auto need = [&](uint32_t list, std::size_t bytes, const char* what) {
    gpu::ensure(indices_[list], *c.device, bytes, gpu::Memory::device, what);
  };
  need(LIST_SIDES, triangle_bytes * indices_per_quad_, "shadow volumes: sides");
  if (caps) need(LIST_NEAR_FRONT, triangle_bytes, "shadow volumes: near caps");
  if (caps) need(LIST_NEAR_BACK, triangle_bytes, "shadow volumes: near caps");
  if (far_caps) need(LIST_FAR, triangle_bytes, "shadow volumes: far caps");
}

ExtractPush Volumes::extract_push(const Case& c) const {
  ExtractPush p{};
  p.light = light_.towards;
  p.positions = c.geometry->positions.address(), p.indices = c.geometry->indices.address();
  p.facing = facing_.address(), p.edges = edges_.edges().address(), p.faces = edges_.faces().address();
  p.lists = lists_.address(), p.draws = draws_.address();
  p.vertex_count = c.geometry->vertex_count, p.indices_per_quad = indices_per_quad_;
  return p;
}

void Volumes::extract(const Case& c, const LightEmission& from, Variant variant, gpu::PassRecorder& passes) {
  const Frame& frame = *c.frame;
  geometry_ = c.geometry;
  light_ = from;
  const Vec3f light = light_.towards.xyz();
  const bool silhouette = params_.extrusion == Extrusion::silhouette;
  // Where the light is outside the scene's bounds, the far cap may be any surface at infinity with the same
  // rim that also leaves out the direction away from the scene: a fan from the rim to one point is far less
  // than the far side of every triangle. At infinity that point is where all rims are.
  const bool caps = variant != Variant::z_pass,
             closed_far = variant == Variant::z_fail && !light_.at_infinity();
  const bool fan = closed_far && silhouette && !contains(frame.geometry.bounds, light);
  const Vec3f apex = normalize(frame.geometry.bounds.center() - light);
  apex_ = {apex.x, apex.y, apex.z, 0};
  indices_per_quad_ = light_.at_infinity() ? 3 : fan ? 9 : 6;
  allocate(c, caps, closed_far && !fan);

  ExtractPush p = extract_push(c);
  p.make = (silhouette ? 0U : MAKE_SIDES) | (caps ? MAKE_NEAR : 0U) | (closed_far && !fan ? MAKE_FAR : 0U) |
           (params_.casters == Casters::light_back_facing ? BACK_FACING_ONLY : 0U);
  Draws empty{};
  for (DrawArguments& a : empty.list) a.instance_count = 1;
  Lists lists{};
  for (uint32_t i = 0; i < LIST_COUNT; ++i) lists.at[i] = indices_[i].address();
  passes.device_pass("facing", [&](gpu::Commands& commands) {
    commands.update(draws_, &empty, sizeof empty);
    commands.update(lists_, &lists, sizeof lists);
    commands.barrier();
    p.count = c.geometry->triangle_count;
    commands.dispatch(facing_pipeline_, p, (p.count + group - 1) / group);
  });
  passes.device_pass("silhouettes", [&](gpu::Commands& commands) {
    p.count = edges_.count();
    if (silhouette) commands.dispatch(silhouette_pipeline_, p, (p.count + group - 1) / group);
    commands.barrier();
    commands.copy(draws_, draws_read_back_, sizeof(Draws));
  });
}

void Volumes::draw(gpu::Commands& commands, const gpu::GraphicsPipeline& pipeline,
                   const Mat4d& clip_from_world, std::initializer_list<uint32_t> lists,
                   std::optional<float> slope_bias) const {
  VolumePush p{};
  p.clip_from_world = to_float(clip_from_world), p.light = light_.towards, p.apex = apex_;
  p.positions = geometry_->positions.address(), p.vertex_count = geometry_->vertex_count;
  commands.bind(pipeline);
  commands.push(pipeline, &p, sizeof p);
  if (slope_bias) commands.set_depth_bias(0, *slope_bias);
  for (uint32_t list : lists)
    if (indices_[list])
      commands.draw_indexed_indirect(indices_[list], draws_,
                                     offsetof(Draws, list) + list * sizeof(DrawArguments));
}

uint64_t Volumes::bytes() const {
  uint64_t sum =
      edges_.bytes() + facing_.bytes() + lists_.bytes() + draws_.bytes() + draws_read_back_.bytes();
  for (const gpu::Buffer& b : indices_) sum += b.bytes();
  return sum;
}

}  // namespace penumbra::shadow_volume
