#include "techniques/stencil_shadow_volume/stencil_shadow_volume.h"

#include "core/error.h"
#include "techniques/common/sample_mean.h"
#include "techniques/stencil_shadow_volume/layers.h"
#include "techniques/stencil_shadow_volume/near_plane.h"
#include "techniques/stencil_shadow_volume/statistics.h"

namespace penumbra {
namespace shadow_volume {
namespace {

// Volumes over each other that the stencil surely counts: 255, less what rounding at rims may add.
constexpr uint32_t safe_layers = 250;

class StencilShadowVolume final : public Technique, public Illustrated {
 public:
  StencilShadowVolume(const Params& params, bool per_sample)
      : params_(params), per_sample_(per_sample), volumes_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    if (!c.device->caps().depth_clamp)
      return "The device cannot clamp depth, which keeps the far caps of shadow volumes at infinity.";
    if (!stencil_supported(*c.device))
      return "The device cannot render to and copy 32-bit depth with an 8-bit stencil.";
    if (c.frame->geometry.positions.size() > UINT32_MAX / 2 - 1)
      return "The scene has more vertices than indices of extruded ones can name.";
    if (params_.casters == Casters::light_back_facing && !c.frame->geometry.closed)
      return "With casters: light_back_facing every mesh has to be closed, which the scene's are not.";
    if (params_.counter == Counter::wide && !FragmentCounts::supported(*c.device))
      return "The device cannot add up floats in a picture, which counter: wide needs.";
    return {};
  }

  void setup(const Case& c, gpu::PassRecorder&) override {
    volumes_.setup(*c.device);
    stencil_.setup(*c.device);
    if (per_sample_) mean_.setup(c);
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    volumes_.build(c, passes);
    layers_ = 0, wide_ = params_.counter == Counter::wide;
    if (params_.counter != Counter::automatic) return;
    passes.host_pass("layers", [&] {
      for (int i = 0; i < light_count(c) && layers_ <= safe_layers; ++i) {
        const Vec4f l = light(c, i).towards;
        layers_ = std::max(layers_, most_layers(c.frame->geometry, {l.x, l.y, l.z, l.w}, safe_layers));
      }
    });
    wide_ = layers_ > safe_layers;
    if (wide_ && !FragmentCounts::supported(*c.device))
      throw PointError(
          "More than 250 volumes may lie over each other: the 8-bit stencil could wrap, and the device "
          "cannot add up floats in a picture instead.");
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    const Case& c = *in.scene_case;
    last_ = {in, params_.variant, 0, wide_, layers_, {}};
    for (int i = 0; i < light_count(c); ++i) {
      render_from(in, light(c, i), per_sample_ ? mean_.lit() : *in.device.visibility, passes);
      if (!per_sample_) continue;
      mean_.add(in, i, passes);
      passes.finish();  // the next light's lists may need more room
    }
  }

  Counters counters() override { return count(params_, volumes_, stencil_, last_); }
  // With many light samples, of the last.
  std::vector<Illustration> illustrations() override { return illustrate(volumes_, stencil_, last_); }

  uint64_t structure_bytes() const override { return volumes_.bytes() + stencil_.bytes() + mean_.bytes(); }

 private:
  int light_count(const Case& c) const { return per_sample_ ? c.light_samples->count() : 1; }
  LightEmission light(const Case& c, int i) const {
    if (!per_sample_) return light_emission(c.frame->light);
    return light_emission(c.frame->light, c.light_samples->points[static_cast<std::size_t>(i)]);
  }

  // A hard shadow.
  void render_from(const RenderInput& in, const LightEmission& light, const gpu::Buffer& to,
                   gpu::PassRecorder& passes) {
    const Case& c = *in.scene_case;
    last_.variant = params_.variant, last_.near_plane.reset();
    if (params_.variant == Variant::zp_plus) {
      const Vec4f l = light.towards;
      last_.near_plane =
          near_plane_from_light(c.frame->camera, in.view_samples->width(), in.view_samples->height(),
                                {l.x, l.y, l.z, l.w}, c.frame->geometry.bounds);
      if (!last_.near_plane) ++last_.fell_back, last_.variant = Variant::z_fail;
    }
    volumes_.extract(c, light, last_.variant, passes);
    stencil_.run(in, volumes_, last_.variant, last_.near_plane, wide_, to, passes);
  }

  Params params_;
  bool per_sample_;
  Volumes volumes_;
  StencilPass stencil_;
  SampleMean mean_;
  LastFrame last_;
  uint32_t layers_ = 0;
  bool wide_ = false;
};

}  // namespace
}  // namespace shadow_volume

namespace {

TechniqueInfo technique_info(bool per_sample) {
  using shadow_volume::param_table;
  TechniqueInfo info;
  info.params = param_table().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.sampled = per_sample;
  info.residence = Residence::device;
  info.origin = [](const ParamValues&) { return Origin::exact; };
  info.make = [per_sample](const ParamValues& values) {
    return std::make_unique<shadow_volume::StencilShadowVolume>(param_table().read(values), per_sample);
  };
  return info;
}

}  // namespace

TechniqueInfo stencil_shadow_volume_technique() {
  TechniqueInfo info = technique_info(false);
  info.name = "stencil_shadow_volume";
  info.title = "Stencil shadow volumes";
  info.sources = {"Magnusson2016", "Crow1977", "Heidmann1991", "Everitt2002", "Hornus2005", "Kim2008"};
  return info;
}

TechniqueInfo stencil_shadow_volume_per_sample_technique() {
  TechniqueInfo info = technique_info(true);
  info.name = "stencil_shadow_volume_per_sample";
  info.title = "Stencil shadow volumes per light sample";
  info.sources = {"Crow1977", "Everitt2002", "Hornus2005", "Kim2008", "Heckbert1997"};
  return info;
}

}  // namespace penumbra
