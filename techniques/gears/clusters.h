// assignment: clusters. Deviation from [GEARS, A.1 to A.3]: no grid. The triangles hang in a box tree whose
// topology is made once and whose boxes are refitted every frame; view samples are grouped by place, and each
// group walks the tree. Reason: a cell's list holds every triangle whose shadow volume's bounding rectangle
// touches the cell, ten times what the cell's view samples need; the tree leaves most of it out and stops
// where the light is already hidden.
#pragma once
#include "techniques/common/sample_groups.h"
#include "techniques/common/triangle_order.h"
#include "techniques/gears/frame_state.h"
#include "techniques/gears/walker.h"

namespace penumbra::gears {

class Clusters {
 public:
  void setup(FrameState& state);
  void build(FrameState& state, const Geometry& geometry, gpu::PassRecorder& passes);
  void render(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes);
  // The last frame once more, with statistics, onto the same masks.
  void count(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes, Counters& counters);
  uint64_t bytes() const { return boxes_.bytes(); }

 private:
  void bind(const FrameState& state);  // the arrays that the kernels fetch from
  void prepare(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes);
  void group(FrameState& state, gpu::PassRecorder& passes);
  void walk(FrameState& state, const RenderInput& in, gpu::PassRecorder& passes,
            Walker::Statistics statistics);

  SampleGroups groups_;
  Walker walker_;
  gpu::ComputePipeline prepare_, refit_;
  gpu::Buffer boxes_;
  gpu::TexelView box_texels_;
  TriangleOrder order_;  // without its slots once they are on the device
  bool bound_ = false;
  uint32_t group_count_ = 0, list_count_ = 0, walks_ = 0;
};

}  // namespace penumbra::gears
