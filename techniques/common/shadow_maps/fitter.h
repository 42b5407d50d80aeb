// Decides, per frame, what each depth map covers: reductions of the view samples on the device, then matrices
// in double precision on the host. The reductions' results are a few hundred bytes; they are the only thing
// read back.
#pragma once
#include <array>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "technique/technique.h"
#include "techniques/common/shadow_maps/light_space.h"
#include "techniques/common/shadow_maps/params.h"

namespace penumbra::shadow_map {

inline constexpr int max_layers = 8;

struct Fitted {
  LightPoint light;
  bool six_faces = false;
  std::vector<FittedLayer> layers;
  std::vector<double> splits;  // view depths at which cascades begin and end
};

class Fitter {
 public:
  explicit Fitter(const Params& params) : params_(params) {}
  void setup(gpu::Device& device);
  // Passes "fit_samples" (view samples' box and depths), "fit_bounds" (per layer; again for warps, and when
  // it takes six faces after all), "fit" (host).
  const Fitted& run(const Case& c, const LightPoint& light, const ViewSamples& view_samples,
                    gpu::PassRecorder& passes);
  const Fitted& result() const { return fitted_; }
  uint64_t bytes() const { return queries_.bytes() + bounds_.bytes() + read_back_.bytes(); }

 private:
  void reset(const Case& c, const LightPoint& light);
  void fit_scene(const Case& c);
  // Frames and spaces of one map, or of cascades. A light that shines to all sides looks at the centre of
  // what is to be covered; where that leaves some of it too far aside, at the middle of the directions to it.
  enum class Aim { center, middle };
  void aim(const Case& c, Aim at);
  void aim_faces();  // of six faces
  void add_layer(const LightFrame& frame);
  bool needs_sample_box() const;
  void query(int slot, const Mat4d& space, double view_lo, double view_hi, double limit);
  void query_layers();
  void reduce(const char* pass, int slots, const ViewSamples& view_samples, gpu::PassRecorder& passes);
  bool outside() const;  // some view sample does not fit one frustum
  void cover_samples(const Case& c);
  void plan_warps(const Case& c);
  void cover_warped();
  void crop_layers(const Case& c);

  Params params_;
  Fitted fitted_;
  Box sample_box_;
  double view_lo_ = 0, view_hi_ = 0;
  double limit_ = 0;  // of |x/w| and |y/w|
  std::array<Mat4d, max_layers> unwarped_;
  gpu::ComputePipeline reduce_;
  gpu::Buffer queries_, bounds_, read_back_;
};

// Lights that shine to all sides take one frustum where it can hold all view samples, else six faces.
inline bool may_need_faces(const LightPoint& light) { return !light.at_infinity() && !light.spot; }

}  // namespace penumbra::shadow_map
