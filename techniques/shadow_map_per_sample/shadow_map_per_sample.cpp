#include "techniques/shadow_map_per_sample/shadow_map_per_sample.h"

#include "techniques/common/sample_mean.h"
#include "techniques/common/shadow_maps/renderer.h"

namespace penumbra {
namespace shadow_map_per_sample {
namespace {

using shadow_map::Params;

// Unfiltered maps are the baseline: the mean over the light is the filter.
std::vector<ParamInfo> infos() {
  std::vector<ParamInfo> all = shadow_map::param_table().infos();
  for (ParamInfo& info : all) {
    if (info.name == "pcf_kernel") info.fallback = int64_t{1};
    if (info.name == "slope_bias") info.fallback = 1.5;
  }
  return all;
}

class ShadowMapPerSample final : public Technique {
 public:
  explicit ShadowMapPerSample(const Params& params) : params_(params), renderer_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    if (params_.filter == shadow_map::Filter::pcss)
      return "Percentage-closer soft shadows take the whole light for each map; here each map has a point of "
             "it.";
    return renderer_.supports(c);
  }

  void setup(const Case& c, gpu::PassRecorder& passes) override {
    renderer_.setup(c, passes);
    mean_.setup(c);
  }

  // As for one map: all work is per frame.
  void build(const Case&, gpu::PassRecorder&) override {}

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    const LightSamples& samples = *in.scene_case->light_samples;
    LightPoint light = light_point(in.scene_case->frame->light);
    RenderInput one = in;
    one.device.visibility = &mean_.lit(), one.device.mask = nullptr;
    for (int i = 0; i < samples.count(); ++i) {
      const Vec4f p = samples.points[static_cast<std::size_t>(i)];
      light.towards = {double(p.x), double(p.y), double(p.z), double(p.w)};
      renderer_.render(one, light, passes);
      mean_.add(in, i, passes);
    }
  }

  Counters counters() override { return renderer_.counters(); }  // of the last light sample

  uint64_t structure_bytes() const override { return renderer_.bytes() + mean_.bytes(); }

 private:
  Params params_;
  shadow_map::Renderer renderer_;
  SampleMean mean_;
};

}  // namespace
}  // namespace shadow_map_per_sample

TechniqueInfo shadow_map_per_sample_technique() {
  TechniqueInfo info;
  info.name = "shadow_map_per_sample";
  info.title = "A shadow map per light sample";
  info.sources = {"Williams1978", "GEARS", "Magnusson2016"};
  info.params = shadow_map_per_sample::infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.sampled = true;
  info.residence = Residence::device;
  info.make = [](const ParamValues& values) {
    return std::make_unique<shadow_map_per_sample::ShadowMapPerSample>(
        shadow_map::param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
