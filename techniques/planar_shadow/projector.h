// Flattened occluders drawn into a stencil, one bit per light sample, and gathered into masks.
#pragma once
#include "technique/technique.h"
#include "techniques/planar_shadow/receiver.h"

namespace penumbra::planar_shadow {

// Why the device cannot do it, or nothing.
std::optional<std::string> missing(gpu::Device& device);

class Projector {
 public:
  void setup(gpu::Device& device);
  // Occluders and receiving triangles. Pass "upload_occluders".
  void build(const Case& c, const Receiver& receiver, gpu::PassRecorder& passes);
  // Passes "flatten", "gather", and "upload_light".
  void run(const RenderInput& in, const Receiver& receiver, gpu::PassRecorder& passes);
  uint32_t occluder_triangles() const { return index_count_ / 3; }
  uint64_t bytes() const;

 private:
  void ensure(const RenderInput& in, gpu::PassRecorder& passes);
  void flatten(gpu::Commands& commands, const RenderInput& in, const Receiver& receiver, int first) const;

  gpu::GraphicsPipeline mark_[8];  // bit i of the stencil
  gpu::ComputePipeline gather_;
  gpu::Image image_;
  gpu::Buffer indices_, on_receiver_, stencil_, points_, weights_;
  uint32_t index_count_ = 0;
};

}  // namespace penumbra::planar_shadow
