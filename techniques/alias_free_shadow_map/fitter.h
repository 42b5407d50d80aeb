// Where the lists lie in the light's view: its direction and windows, fitted to the view samples or to the scene.
#pragma once
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
  // Passes "fit_box" and "fit_window" (device), "fit" (host).
  const LightView& run(const RenderInput& in, gpu::PassRecorder& passes);
  // Faces that some view sample is seen through.
  bool used(uint32_t face) const { return used_[face]; }
  // Where the view of the last run() is on the device.
  const gpu::Buffer& view_buffer() const { return view_buffer_; }
  uint64_t bytes() const { return view_buffer_.bytes() + bounds_.bytes() + read_back_.bytes(); }

 private:
  void fit_samples(const RenderInput& in, gpu::PassRecorder& passes);
  void fit_scene(const Case& c);
  void reduce(const char* pass, uint32_t first_face, uint32_t faces, float limit, const RenderInput& in,
              gpu::PassRecorder& passes);
  void cover(uint32_t face, const Extent& extent);

  Params params_;
  gpu::ComputePipeline reduce_;
  gpu::Buffer view_buffer_, bounds_, read_back_;
  LightPoint light_{};
  LightView view_{};
  double diagonal_ = 0;
  bool used_[most_faces] = {};
};

// Where the shadow segments begin, per pixel.
const gpu::Buffer& segment_origins(const Params& params, const ViewSamples& view);

}  // namespace penumbra::alias_free
