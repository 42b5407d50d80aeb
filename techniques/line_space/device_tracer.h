// Shadow segments followed on the device.
#pragma once
#include "technique/technique.h"
#include "techniques/line_space/device_tree.h"
#include "techniques/line_space/params.h"

namespace penumbra::line_space {

class DeviceTracer {
 public:
  void setup(gpu::Device& device, uint32_t branching, uint32_t depth,
             Params::Start start = Params::Start::node);
  // After the tree was made.
  void bind(const DeviceTree& tree);
  // Passes "upload_light", "trace", "resolve".
  void run(const RenderInput& in, const Grid& grid, const DeviceTree& tree, gpu::PassRecorder& passes);
  uint64_t bytes() const { return points_.bytes() + weights_.bytes() + constants_.bytes(); }

 private:
  void upload(const RenderInput& in, const Grid& grid, gpu::PassRecorder& passes);

  gpu::ComputePipeline trace_, trace_images_, resolve_;
  gpu::Buffer points_, weights_, constants_;
  TraceConstants values_{};
};

}  // namespace penumbra::line_space
