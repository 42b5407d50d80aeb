#include "techniques/sample_based_soft/casters.h"

#include <algorithm>

#include "scene/mesh.h"
#include "shaders/sample_based_soft_face_light.h"
#include "shaders/sample_based_soft_prepare_casters.h"

namespace penumbra::sample_based_soft {

void Casters::setup(const FrameState& state) {
  lanes_ = state.lanes;
  blocks_ = state.params.regions == Params::Regions::blocks;
  silhouettes_ = state.params.restrict_to_penumbra;
  // As many as the light's bounding polygon has points, three times; see outline.glsl.
  outline_texels_ = blocks_ ? 0 : state.light.ball ? 18 : 12;
  const gpu::Specialization constants[] = {{0, lanes_},       {1, state.light.layout.grid},
                                           {2, blocks_},      {3, state.params.cull_back_faces},
                                           {4, silhouettes_}, {5, state.light.ball}};
  gpu::Device& device = *state.device;
  const gpu::ImageUse images[] = {gpu::ImageUse::sampled_nearest};
  face_ =
      gpu::ComputePipeline(device, sample_based_soft_face_light_spv, sizeof(CastersConstants), {}, images);
  prepare_ = gpu::ComputePipeline(device, sample_based_soft_prepare_casters_spv, sizeof(CastersConstants),
                                  constants, images);
}

void Casters::bind(const FrameState& state) {
  const VkImageView views[] = {state.frame_texels.view()};
  face_.bind_images(views);
  prepare_.bind_images(views);
}

void Casters::build_topology(const FrameState& state, const Geometry& geometry, gpu::PassRecorder& passes) {
  TriangleOrder order;
  passes.host_pass("order_triangles",
                   [&] { order = order_triangles(geometry, lanes_, state.params.triangle_order); });
  passes.finish();
  triangle_count_ = static_cast<uint32_t>(geometry.triangle_count());
  block_slots_ = order.tree_slots;
  slots_ = static_cast<uint32_t>(order.slots.size());
  const auto ensure = [&](gpu::Buffer& b, std::size_t bytes, const char* what) {
    gpu::ensure(b, *state.device, std::max<std::size_t>(bytes, 16), gpu::Memory::device, what);
  };
  ensure(order_, order.slots.size() * 4, "the order of the triangles");
  ensure(facing_, std::size_t{triangle_count_} * 4, "sides of the triangles");
  ensure(triangles_, std::size_t{slots_} * 3 * sizeof(Vec4f), "triangles in working space");
  ensure(regions_, std::size_t{count()} * 2 * sizeof(Vec4f), "influence regions");
  ensure(edges_, silhouettes_ ? std::size_t{count()} * 2 * sizeof(Vec4f) : 16, "silhouettes' regions");
  ensure(outlines_, std::size_t{count()} * outline_texels_ * sizeof(Vec4f), "influence regions");
  ensure(list_, std::size_t{slots_} * 4, "triangles outside the blocks");
  triangle_texels_.ensure(*state.device, passes, std::size_t{slots_} * 3, "triangles in working space");
  region_texels_.ensure(*state.device, passes, std::size_t{count()} * 2, "influence regions");
  edge_texels_.ensure(*state.device, passes, silhouettes_ ? std::size_t{count()} * 2 : 1, "silhouettes");
  outline_array_.ensure(*state.device, passes, std::size_t{count()} * outline_texels_, "influence regions");
  gpu::upload(passes, "upload_order", order_, order.slots.data(), order.slots.size() * 4);
  if (silhouettes_)
    build_neighbours(geometry, passes);
  else
    ensure(neighbours_, 16, "neighbours of the triangles");
}

// Across each edge the one other triangle that runs it the other way; where there is none, or several, the
// edge is a silhouette whatever the light.
void Casters::build_neighbours(const Geometry& geometry, gpu::PassRecorder& passes) {
  std::vector<uint32_t> neighbours(3 * geometry.triangle_count(), no_triangle);
  passes.host_pass("adjacency", [&] {
    const Adjacency adjacency = build_adjacency(geometry.positions, geometry.indices);
    const auto corner = [&](uint32_t triangle, uint32_t k) {
      return adjacency.welded[geometry.indices[3 * triangle + k % 3]];
    };
    const auto side = [&](const EdgeFace& face, const Edge& edge) {
      const uint32_t from = edge.vertex[face.sign > 0 ? 0 : 1], to = edge.vertex[face.sign > 0 ? 1 : 0];
      uint32_t k = 0;
      while (k < 2 && !(corner(face.triangle, k) == from && corner(face.triangle, k + 1) == to)) ++k;
      return k;
    };
    for (const Edge& edge : adjacency.edges) {
      if (edge.face_count != 2) continue;
      const EdgeFace &a = adjacency.faces[edge.first_face], &b = adjacency.faces[edge.first_face + 1];
      if (a.sign == b.sign) continue;
      neighbours[3 * a.triangle + side(a, edge)] = b.triangle;
      neighbours[3 * b.triangle + side(b, edge)] = a.triangle;
    }
  });
  passes.finish();
  gpu::ensure(neighbours_, passes.device(), neighbours.size() * 4, gpu::Memory::device,
              "neighbours of the triangles");
  gpu::upload(passes, "upload_neighbours", neighbours_, neighbours.data(), neighbours.size() * 4);
}

void Casters::build_closed(const FrameState& state, const Case& c, gpu::PassRecorder& passes) {
  const Geometry& g = c.frame->geometry;
  std::vector<uint32_t> bits((g.triangle_count() + 31) / 32 + 1, 0U);
  passes.host_pass("find_closed", [&] {
    const auto instance_of = [&](std::size_t t) {
      return g.triangle_instance.empty() ? 0 : g.triangle_instance[t];
    };
    std::vector<Box> boxes(std::max<std::size_t>(g.instance_closed.size(), 1));
    for (std::size_t t = 0; t < g.triangle_count(); ++t)
      for (int k = 0; k < 3 && instance_of(t) < boxes.size(); ++k)
        boxes[instance_of(t)].extend(g.corner(t, k));
    const Box light = sample_box(*c.light_samples);
    for (std::size_t t = 0; t < g.triangle_count(); ++t) {
      const std::size_t i = instance_of(t);
      const bool closed = i < g.instance_closed.size() ? g.instance_closed[i] != 0 : g.closed;
      if (closed && i < boxes.size() && outside(light, boxes[i])) bits[t / 32] |= 1U << (t % 32);
    }
  });
  passes.finish();
  gpu::ensure(closed_, *state.device, bits.size() * 4, gpu::Memory::device, "closed meshes' triangles");
  gpu::upload(passes, "upload_closed", closed_, bits.data(), bits.size() * 4);
}

void Casters::prepare(const FrameState& state, const Case& c, gpu::PassRecorder& passes) {
  CastersConstants pc{};
  pc.frame = state.frame.address();
  pc.header = state.header.address();
  pc.positions = c.geometry->positions.address();
  pc.indices = c.geometry->indices.address();
  pc.order = order_.address();
  pc.closed = closed_.address();
  pc.facing = facing_.address();
  pc.neighbours = neighbours_.address();
  pc.triangles = triangles_.address();
  pc.regions = regions_.address();
  pc.edges = edges_.address();
  pc.hulls = outlines_.address();
  pc.list = list_.address();
  pc.triangle_count = triangle_count_;
  pc.block_slots = block_slots_;
  pc.slots = slots_;
  passes.device_pass("prepare_casters", [&](gpu::Commands& commands) {
    commands.dispatch(face_, pc, groups_for(triangle_count_, wide_lanes));
    commands.barrier();
    commands.dispatch(prepare_, pc, groups_for(slots_, lanes_));
    commands.barrier();
    triangle_texels_.copy_from(commands, triangles_, std::size_t{slots_} * 3);
    region_texels_.copy_from(commands, regions_, std::size_t{count()} * 2);
    if (silhouettes_) edge_texels_.copy_from(commands, edges_, std::size_t{count()} * 2);
    outline_array_.copy_from(commands, outlines_, std::size_t{count()} * outline_texels_);
  });
}

uint64_t Casters::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b :
       {&order_, &closed_, &facing_, &neighbours_, &triangles_, &regions_, &edges_, &outlines_, &list_})
    sum += b->bytes();
  for (const TexelArray* t : {&triangle_texels_, &region_texels_, &edge_texels_, &outline_array_})
    sum += t->bytes();
  return sum;
}

}  // namespace penumbra::sample_based_soft
