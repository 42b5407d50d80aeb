#include "techniques/shadow_map/shadow_map.h"

#include <fmt/format.h>

#include "techniques/shadow_map/counters.h"
#include "techniques/shadow_map/lookup.h"

namespace penumbra {
namespace shadow_map {
namespace {

class ShadowMap final : public Technique {
 public:
  explicit ShadowMap(const Params& params)
      : params_(params), fitter_(params), maps_(params), lookup_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    const gpu::Capabilities& caps = c.device->caps();
    if (!caps.depth_clamp)
      return "The device cannot clamp depth, which keeps casters in front of a fitted map's near plane.";
    if (static_cast<uint32_t>(params_.map_size) > caps.max_image_2d)
      return fmt::format("The device's images have at most {0} x {0} texels, map_size is {1}.",
                         caps.max_image_2d, params_.map_size);
    if (!supported(*c.device, params_.depth_format))
      return "The device cannot render to and read from depth_format.";
    return {};
  }

  void setup(const Case& c, gpu::PassRecorder& passes) override {
    fitter_.setup(*c.device);
    maps_.setup(*c.device);
    lookup_.setup(*c.device, passes);
  }

  // A depth map depends on the camera through its fit: all work is per frame.
  void build(const Case&, gpu::PassRecorder&) override {}

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    const Fitted& fitted = fitter_.run(*in.scene_case, *in.view_samples, passes);
    maps_.draw(*in.scene_case, fitted, passes);
    lookup_.run(in, fitted, maps_, passes);
    last_ = in;
  }

  Counters counters() override { return count(params_, fitter_.result(), maps_, last_); }

  uint64_t structure_bytes() const override { return fitter_.bytes() + maps_.bytes() + lookup_.bytes(); }

 private:
  Params params_;
  Fitter fitter_;
  DepthMaps maps_;
  Lookup lookup_;
  RenderInput last_;
};

}  // namespace
}  // namespace shadow_map

TechniqueInfo shadow_map_technique() {
  using shadow_map::param_table;
  TechniqueInfo info;
  info.name = "shadow_map";
  info.title = "Shadow mapping";
  info.sources = {"Williams1978", "Reeves1987, sec. 3", "Magnusson2016"};
  info.params = param_table().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.sampled = false;
  info.residence = Residence::device;
  info.make = [](const ParamValues& values) {
    return std::make_unique<shadow_map::ShadowMap>(param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
