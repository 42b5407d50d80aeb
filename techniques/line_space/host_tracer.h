// Shadow segments followed on the host (backend=cpu), by the code of the device (shaders/traverse.glsl).
#pragma once
#include <span>
#include <vector>

#include "samples/light_samples.h"
#include "samples/view_samples.h"
#include "scene/light.h"
#include "techniques/line_space/tree.h"

namespace penumbra::line_space {

class HostTracer {
 public:
  // References are kept.
  HostTracer(const Pools& pools, const Grid& grid, Params::Start start = Params::Start::node)
      : pools_(pools), grid_(grid), start_(static_cast<uint32_t>(start)) {}

  // The segment from `origin` to a light sample (w = 0: without end) is taken for blocked.
  bool blocked(Vec3f origin, Vec4f light_point) const;
  // The fine cell in which a segment from `origin` begins, whose node is skipped; false: it begins outside
  // the tree.
  bool start_cell(Vec3f origin, Vec3f& cell) const;
  // Masks and visibility, in the layout of HostOutput.
  void run(const Light& light, const LightSamples& samples, const ViewSamplesHost& view,
           std::span<uint32_t> mask, std::span<float> visibility) const;

 private:
  void pixel(const LightSamples& samples, Vec4f emission, const ViewSamplesHost& view, std::size_t i,
             uint32_t* mask, float& visibility) const;
  const Pools& pools_;
  const Grid& grid_;
  uint32_t start_;
};

}  // namespace penumbra::line_space
