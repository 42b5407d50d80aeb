// Flattened occluders drawn into stencils, one bit per light sample, and gathered into masks.
#pragma once
#include <vector>

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
  void gather(const RenderInput& in, int first, int end, gpu::PassRecorder& passes) const;

  gpu::GraphicsPipeline mark_[8];  // bit i of the stencil
  gpu::ComputePipeline gather_, gather_each_;
  gpu::Image image_;
  gpu::Buffer indices_, on_receiver_, stencil_, points_, weights_, dark_;
  std::vector<uint32_t> dark_words_;
  bool each_pixel_ = false;  // the horizon differs among the receiver's points
  int slices_ = 0;           // stencils that stencil_ holds
  uint32_t index_count_ = 0;
};

}  // namespace penumbra::planar_shadow
