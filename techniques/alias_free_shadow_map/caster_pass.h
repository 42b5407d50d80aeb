// Every shadow-casting triangle against the lists of the texels that it touches [Sintorn2008, sec. 3.2, 3.3].
#pragma once
#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "techniques/alias_free_shadow_map/casters.h"
#include "techniques/alias_free_shadow_map/sample_lists.h"

namespace penumbra::alias_free {

class CasterPass {
 public:
  explicit CasterPass(const Params& params) : params_(params) {}
  void setup(const Case& c);
  void build(const Case& c, const Casters& casters);
  // Passes "cast_triangles", "cast_items" and, where a closed mesh is seen from the inside, "cast_inner".
  void run(const Casters& casters, const Fitter& fitter, const SampleLists& lists, gpu::PassRecorder& passes);
  // The same again, counting the tests of a triangle against a view sample.
  double count_pairs(const Casters& casters, const Fitter& fitter, const SampleLists& lists,
                     gpu::PassRecorder& passes);
  // For SampleLists, which notes the view samples on closed meshes' inside in it.
  const gpu::Buffer& progress() const { return progress_; }
  uint64_t bytes() const {
    return crowded_.bytes() + items_.bytes() + progress_.bytes() + progress_host_.bytes();
  }

 private:
  struct Kernels {
    gpu::ComputePipeline triangles, make_items, items, inner;
  };
  void bind(const Casters& casters, const Fitter& fitter, const SampleLists& lists);
  void cast(const Casters& casters, const Fitter& fitter, const SampleLists& lists, bool counting,
            gpu::PassRecorder& passes);
  void cast_all(CastPush pc, uint32_t first, uint32_t count, const Fitter& fitter, const Kernels& kernels,
                gpu::PassRecorder& passes);
  void cast_crowded(CastPush pc, const Kernels& kernels, gpu::PassRecorder& passes);
  void read(gpu::PassRecorder& passes, const char* pass);
  Progress progress_read() const { return progress_host_.view<Progress>()[0]; }
  uint32_t items_per_triangle() const;

  Params params_;
  Kernels kernels_[2];  // [counting]
  gpu::Buffer crowded_, items_, progress_, progress_host_;
};

}  // namespace penumbra::alias_free
