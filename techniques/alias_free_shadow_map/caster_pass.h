// Every shadow-casting triangle against the lists of the texels that it touches [Sintorn2008, sec. 3.2, 3.3].
#pragma once
#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "techniques/alias_free_shadow_map/sample_lists.h"

namespace penumbra::alias_free {

class CasterPass {
 public:
  explicit CasterPass(const Params& params) : params_(params) {}
  void setup(const Case& c);
  // Which triangles belong to closed meshes.
  void build(const Case& c, gpu::PassRecorder& passes);
  // Pass "cull_triangles": which triangles cast. Before the lists are filled.
  void cull(const Case& c, const Fitter& fitter, gpu::PassRecorder& passes);
  // Passes "cast_begin", "cast_triangles", "cast_items" and, where a closed mesh is seen from the inside,
  // "cast_inner".
  void run(const Case& c, const Fitter& fitter, const SampleLists& lists, gpu::PassRecorder& passes);
  // The same again, counting the tests of a triangle against a view sample.
  double count_pairs(const Case& c, const Fitter& fitter, const SampleLists& lists,
                     gpu::PassRecorder& passes);
  const gpu::Buffer& away() const { return away_; }  // as CastPush
  const gpu::Buffer& progress() const { return progress_; }
  uint64_t bytes() const;

 private:
  struct Kernels {
    gpu::ComputePipeline triangles, items, inner;
  };
  CastPush push(const Case& c, const Fitter& fitter) const;
  void cast(const Case& c, const Fitter& fitter, const SampleLists& lists, bool counting,
            gpu::PassRecorder& passes);
  void cast_all(CastPush pc, uint32_t first, uint32_t count, const Fitter& fitter, const Kernels& kernels,
                gpu::PassRecorder& passes);
  void cast_chunk(CastPush pc, const Kernels& kernels, gpu::PassRecorder& passes);
  Progress read_progress() const { return progress_host_.view<Progress>()[0]; }
  uint32_t items_per_triangle() const;

  Params params_;
  gpu::ComputePipeline cull_;
  Kernels kernels_[2];  // [counting]
  gpu::Buffer closed_, away_, casters_, items_, progress_, progress_host_;
  uint32_t triangle_count_ = 0;
};

}  // namespace penumbra::alias_free
