// The triangles as the casting kernels read them: corners side by side, and which of them cast. Nothing here
// depends on the view: made when the geometry or the light is new.
#pragma once
#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/alias_free_shadow_map/params.h"
#include "techniques/alias_free_shadow_map/shaders/shared.h"
#include "techniques/common/texel_array.h"

namespace penumbra::alias_free {

class Casters {
 public:
  explicit Casters(const Params& params) : params_(params) {}
  void setup(const Case& c);
  // Passes "upload_closed" (topology), "gather_corners" (positions), "face_light" (either, and the light).
  void build(const Case& c, gpu::PassRecorder& passes);

  uint32_t triangle_count() const { return triangle_count_; }
  uint32_t caster_count() const { return counts_[0]; }  // at the front of list()
  uint32_t front_count() const { return counts_[1]; }   // at its back
  const gpu::Buffer& list() const { return list_; }     // FacingPush::casters
  const gpu::Buffer& away() const { return away_; }     // FacingPush::away
  const gpu::Buffer& boxes() const { return boxes_; }   // FacingPush::boxes
  const TexelArray& corners() const { return corner_texels_; }
  uint64_t bytes() const;

 private:
  void build_topology(const Case& c, gpu::PassRecorder& passes);
  void gather(const Case& c, gpu::PassRecorder& passes);
  void face_light(const Case& c, gpu::PassRecorder& passes);

  Params params_;
  gpu::ComputePipeline gather_, face_, box_;
  gpu::Buffer closed_, corners_, list_, away_, boxes_, counts_device_, counts_host_;
  TexelArray corner_texels_;
  uint32_t triangle_count_ = 0, counts_[2] = {0, 0};
  bool built_ = false;
};

}  // namespace penumbra::alias_free
