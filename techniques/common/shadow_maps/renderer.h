// Shadow maps of one light position: fit, depth maps, moments where the filter needs them, lookup. What
// shadow_map does once a frame, shadow_map_per_sample for each light sample.
#pragma once
#include <optional>
#include <string>

#include "technique/illustration.h"
#include "techniques/common/shadow_maps/lookup.h"

namespace penumbra::shadow_map {

class Renderer {
 public:
  explicit Renderer(const Params& params)
      : params_(params), fitter_(params), maps_(params), moments_(params), lookup_(params) {}

  // Why device, parameters or light do not go together (a full sentence), or nothing.
  std::optional<std::string> supports(const Case& c) const;
  void setup(const Case& c, gpu::PassRecorder& passes);
  // Writes in.device.visibility: what `light` reaches. Allocates on the first call, and when a frame takes
  // more maps than any before.
  void render(const RenderInput& in, const LightPoint& light, gpu::PassRecorder& passes);

  // Of the last render.
  Counters counters() const;
  std::vector<Illustration> illustrations() const;
  uint64_t bytes() const { return fitter_.bytes() + maps_.bytes() + moments_.bytes() + lookup_.bytes(); }

 private:
  std::optional<std::string> supports_combination() const;
  std::optional<std::string> supports_light(const Case& c) const;

  Params params_;
  Fitter fitter_;
  DepthMaps maps_;
  MomentMaps moments_;
  Lookup lookup_;
  RenderInput last_;
};

}  // namespace penumbra::shadow_map
