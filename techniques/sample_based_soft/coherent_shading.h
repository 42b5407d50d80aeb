// Coherent shading with bent vertex normals [Sintorn2008, sec. 4.3]: the cosine of the shaded picture, black
// wherever a face turns away from the light's centre, so that accurate shadows meet no lit back faces.
#pragma once
#include "gpu/pipeline.h"
#include "techniques/sample_based_soft/frame_state.h"

namespace penumbra::sample_based_soft {

class CoherentShading {
 public:
  void setup(const FrameState& state);
  // The faces around each vertex. Once for a topology.
  void build(const FrameState& state, const Geometry& geometry, gpu::PassRecorder& passes);
  // Pass "coherent_shading".
  void run(const FrameState& state, const RenderInput& in, gpu::PassRecorder& passes);
  // Per pixel, row-major, >= 0; 0 where there is no view sample.
  std::vector<float> download(const FrameState& state, gpu::PassRecorder& passes) const;
  uint64_t bytes() const;

 private:
  gpu::ComputePipeline bend_, shade_;
  gpu::Buffer first_faces_, faces_, corner_, bent_, cosines_;
  uint32_t vertices_ = 0;  // welded
};

}  // namespace penumbra::sample_based_soft
