#include "techniques/sample_based_soft/coherent_shading.h"

#include <algorithm>

#include "scene/mesh.h"
#include "shaders/sample_based_soft_bend_normals.h"
#include "shaders/sample_based_soft_shade_coherently.h"

namespace penumbra::sample_based_soft {

void CoherentShading::setup(const FrameState& state) {
  bend_ = gpu::ComputePipeline(*state.device, sample_based_soft_bend_normals_spv, sizeof(ShadeConstants));
  shade_ =
      gpu::ComputePipeline(*state.device, sample_based_soft_shade_coherently_spv, sizeof(ShadeConstants));
}

void CoherentShading::build(const FrameState& state, const Geometry& geometry, gpu::PassRecorder& passes) {
  std::vector<uint32_t> first, faces, corner;
  passes.host_pass("faces_of_vertices", [&] {
    // Welded, so that faces meet across seams of normals and texture coordinates too.
    corner = build_adjacency(geometry.positions, geometry.indices).welded;
    vertices_ = corner.empty() ? 0 : *std::ranges::max_element(corner) + 1;
    first.assign(vertices_ + 1, 0);
    for (const uint32_t i : geometry.indices) ++first[corner[i] + 1];
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    std::vector<uint32_t> next = first;
    faces.resize(geometry.indices.size());
    for (std::size_t i = 0; i < faces.size(); ++i)
      faces[next[corner[geometry.indices[i]]]++] = static_cast<uint32_t>(i);
  });
  passes.finish();
  const auto send = [&](gpu::Buffer& b, const std::vector<uint32_t>& values, const char* what) {
    gpu::ensure(b, *state.device, std::max<std::size_t>(values.size() * 4, 4), gpu::Memory::device, what);
    if (!values.empty()) gpu::upload(passes, "upload_faces", b, values.data(), values.size() * 4);
  };
  send(first_faces_, first, "faces around the vertices");
  send(faces_, faces, "faces around the vertices");
  send(corner_, corner, "welded vertices");
  gpu::ensure(bent_, *state.device, std::max<std::size_t>(vertices_ * 8, 8), gpu::Memory::device,
              "bent normals");
}

void CoherentShading::run(const FrameState& state, const RenderInput& in, gpu::PassRecorder& passes) {
  gpu::ensure(cosines_, *state.device, std::size_t{state.pixels()} * 4, gpu::Memory::device, "cosines");
  const Case& c = *in.scene_case;
  const ViewSamples& view = *in.view_samples;
  const Vec3f light = c.frame->light.center;
  ShadeConstants pc{};
  pc.positions = c.geometry->positions.address();
  pc.indices = c.geometry->indices.address();
  pc.barycentrics = view.barycentrics().address();
  pc.triangle = view.triangle().address();
  pc.position = view.position().address();
  pc.normal = view.geometric_normal().address();
  pc.shading_normal = view.shading_normal().address();
  pc.first_faces = first_faces_.address();
  pc.faces = faces_.address();
  pc.corner = corner_.address();
  pc.bent = bent_.address();
  pc.cosines = cosines_.address();
  pc.light[0] = light.x, pc.light[1] = light.y, pc.light[2] = light.z;
  pc.weight = state.params.bend_weight;
  passes.device_pass("coherent_shading", [&](gpu::Commands& commands) {
    pc.count = vertices_;
    commands.dispatch(bend_, pc, groups_for(vertices_, wide_lanes));
    commands.barrier();
    pc.count = state.pixels();
    commands.dispatch(shade_, pc, groups_for(state.pixels(), wide_lanes));
  });
}

std::vector<float> CoherentShading::download(const FrameState& state, gpu::PassRecorder& passes) const {
  std::vector<float> cosines(state.pixels());
  gpu::download(passes, "read_cosines", cosines_, cosines.data(), cosines.size() * 4);
  passes.finish();
  return cosines;
}

uint64_t CoherentShading::bytes() const {
  uint64_t sum = 0;
  for (const gpu::Buffer* b : {&first_faces_, &faces_, &corner_, &bent_, &cosines_}) sum += b->bytes();
  return sum;
}

}  // namespace penumbra::sample_based_soft
