// Where the lists lie in the light's view: its direction and windows, fitted to the view samples or to the
// scene.
#pragma once
#include <algorithm>
#include <iterator>

#include "gpu/pass_recorder.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/alias_free_shadow_map/light_view.h"
#include "techniques/alias_free_shadow_map/params.h"

namespace penumbra::alias_free {

class Fitter {
 public:
  explicit Fitter(const Params& params) : params_(params) {}
  void setup(const Case& c);
  // Passes "gather" and "fit_window" (device), "fit" (host).
  const LightView& run(const RenderInput& in, gpu::PassRecorder& passes);
  // Faces that some view sample is seen through.
  bool any_used() const {
    return std::any_of(std::begin(used_), std::end(used_), [](bool u) { return u; });
  }
  bool used(uint32_t face) const { return used_[face]; }
  // Of the last run(), on the device: the view; and per pixel where its shadow segment begins, and its own
  // triangle or not_listed.
  const gpu::Buffer& view_buffer() const { return view_buffer_; }
  const gpu::Buffer& samples() const { return samples_; }
  uint64_t bytes() const {
    return view_buffer_.bytes() + samples_.bytes() + bounds_.bytes() + read_back_.bytes();
  }

 private:
  void fit_samples(const RenderInput& in, gpu::PassRecorder& passes);
  void fit_scene(const Case& c);
  void gather(const RenderInput& in, gpu::PassRecorder& passes);
  void bound(uint32_t faces, float limit, gpu::PassRecorder& passes);
  void reduce(const char* pass, const gpu::ComputePipeline& kernel, BoundsPush push, uint32_t faces,
              gpu::PassRecorder& passes);
  void cover(uint32_t face, const Extent& extent);

  Params params_;
  gpu::ComputePipeline gather_, bound_;
  gpu::Buffer view_buffer_, samples_, bounds_, read_back_;
  uint32_t pixels_ = 0;
  LightPoint light_{};
  LightView view_{};
  double diagonal_ = 0;
  bool used_[most_faces] = {};
};

}  // namespace penumbra::alias_free
