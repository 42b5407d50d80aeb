// The shadow volumes of one frame, as lists of indices made on the device.
#pragma once
#include <optional>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/common/edges_on_device.h"
#include "techniques/common/light_emission.h"
#include "techniques/stencil_shadow_volume/params.h"
#include "techniques/stencil_shadow_volume/shaders/shared.h"

namespace penumbra::shadow_volume {

class Volumes {
 public:
  explicit Volumes(const Params& params) : params_(params) {}
  void setup(gpu::Device& device);
  // Which edges have which triangles: the topology alone, kept while welded vertices move together. Passes
  // "adjacency" (host), "upload_adjacency".
  void build(const Case& c, gpu::PassRecorder& passes);
  // Lists for z-pass (sides), ZP+ (and near caps) or z-fail (and far caps). Passes "facing", "silhouettes".
  void extract(const Case& c, const LightEmission& light, Variant variant, gpu::PassRecorder& passes);
  // Draws lists of the last extract(); those that are not part of it are empty. `slope_bias`: for pipelines
  // that push depth back.
  void draw(gpu::Commands& commands, const gpu::GraphicsPipeline& pipeline, const Mat4d& clip_from_world,
            std::initializer_list<uint32_t> lists, std::optional<float> slope_bias = {}) const;

  Draws read_draws() const { return *static_cast<const Draws*>(draws_read_back_.mapped()); }
  uint32_t indices_per_quad() const { return indices_per_quad_; }
  const gpu::Buffer& indices(uint32_t list) const { return indices_[list]; }
  const LightEmission& light() const { return light_; }
  uint64_t bytes() const;

 private:
  void allocate(const Case& c, bool caps, bool far_caps);
  ExtractPush extract_push(const Case& c) const;

  Params params_;
  gpu::ComputePipeline facing_pipeline_, silhouette_pipeline_;
  EdgesOnDevice edges_;
  gpu::Buffer facing_, lists_, draws_, draws_read_back_;
  gpu::Buffer indices_[LIST_COUNT];
  LightEmission light_;
  Vec4f apex_;
  const GeometryOnDevice* geometry_ = nullptr;
  uint32_t indices_per_quad_ = 0;
};

}  // namespace penumbra::shadow_volume
