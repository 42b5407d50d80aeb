#include "techniques/stencil_shadow_volume/stencil_shadow_volume.h"

#include "core/error.h"
#include "techniques/stencil_shadow_volume/layers.h"
#include "techniques/stencil_shadow_volume/near_plane.h"
#include "techniques/stencil_shadow_volume/statistics.h"

namespace penumbra {
namespace shadow_volume {
namespace {

// Volumes over each other that the stencil surely counts: 255, less what rounding at rims may add.
constexpr uint32_t safe_layers = 250;

class StencilShadowVolume final : public Technique {
 public:
  explicit StencilShadowVolume(const Params& params) : params_(params), volumes_(params) {}

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
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    volumes_.build(c, passes);
    wide_ = params_.counter == Counter::wide;
    if (params_.counter != Counter::automatic) return;
    passes.host_pass("layers", [&] {
      const Vec4f l = light_emission(c.frame->light).towards;
      layers_ = most_layers(c.frame->geometry, {l.x, l.y, l.z, l.w}, safe_layers);
    });
    wide_ = layers_ > safe_layers;
    if (wide_ && !FragmentCounts::supported(*c.device))
      throw PointError(
          "More than 250 volumes may lie over each other: the 8-bit stencil could wrap, and the device "
          "cannot add up floats in a picture instead.");
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    const Case& c = *in.scene_case;
    last_ = {in, params_.variant, false, wide_, layers_, {}};
    if (params_.variant == Variant::zp_plus) {
      const Vec4f l = light_emission(c.frame->light).towards;
      last_.near_plane =
          near_plane_from_light(c.frame->camera, in.view_samples->width(), in.view_samples->height(),
                                {l.x, l.y, l.z, l.w}, c.frame->geometry.bounds);
      last_.fell_back = !last_.near_plane;
      if (last_.fell_back) last_.variant = Variant::z_fail;
    }
    volumes_.extract(c, last_.variant, passes);
    stencil_.run(in, volumes_, last_.variant, last_.near_plane, wide_, passes);
  }

  Counters counters() override { return count(params_, volumes_, stencil_, last_); }

  uint64_t structure_bytes() const override { return volumes_.bytes() + stencil_.bytes(); }

 private:
  Params params_;
  Volumes volumes_;
  StencilPass stencil_;
  LastFrame last_;
  uint32_t layers_ = 0;
  bool wide_ = false;
};

}  // namespace
}  // namespace shadow_volume

TechniqueInfo stencil_shadow_volume_technique() {
  using shadow_volume::param_table;
  TechniqueInfo info;
  info.name = "stencil_shadow_volume";
  info.title = "Stencil shadow volumes";
  info.sources = {"Magnusson2016", "Crow1977", "Heidmann1991", "Everitt2002", "Hornus2005", "Kim2008"};
  info.params = param_table().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.sampled = false;
  info.residence = Residence::device;
  info.origin = [](const ParamValues&) { return Origin::exact; };
  info.make = [](const ParamValues& values) {
    return std::make_unique<shadow_volume::StencilShadowVolume>(param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
