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
      : params_(params), fitter_(params), maps_(params), moments_(params), lookup_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    const gpu::Capabilities& caps = c.device->caps();
    if (!caps.depth_clamp)
      return "The device cannot clamp depth, which keeps casters in front of a fitted map's near plane.";
    if (static_cast<uint32_t>(params_.map_size) > caps.max_image_2d)
      return fmt::format("The device's images have at most {0} x {0} texels, map_size is {1}.",
                         caps.max_image_2d, params_.map_size);
    if (!supported(*c.device, params_.depth_format))
      return "The device cannot render to and read from depth_format.";
    if (auto reason = supports_combination()) return reason;
    return supports_light(c);
  }

  void setup(const Case& c, gpu::PassRecorder& passes) override {
    fitter_.setup(*c.device);
    maps_.setup(*c.device);
    if (params_.filterable()) moments_.setup(*c.device);
    lookup_.setup(*c.device, c.frame->light.kind == LightKind::sphere, passes);
  }

  // A depth map depends on the camera through its fit: all work is per frame.
  void build(const Case&, gpu::PassRecorder&) override {}

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    const Fitted& fitted = fitter_.run(*in.scene_case, *in.view_samples, passes);
    maps_.draw(*in.scene_case, fitted, passes);
    if (params_.filterable()) moments_.run(fitted, maps_, passes);
    lookup_.run(in, fitted, maps_, moments_, passes);
    last_ = in;
  }

  Counters counters() override {
    return count(params_, fitter_.result(), maps_.image().bytes() + moments_.bytes(), last_);
  }

  uint64_t structure_bytes() const override {
    return fitter_.bytes() + maps_.bytes() + moments_.bytes() + lookup_.bytes();
  }

 private:
  std::optional<std::string> supports_combination() const {
    const bool warped = params_.warp != Warp::none;
    if (params_.fit != Fit::tight && warped)
      return "A warp is made for the view samples of its frame: it takes fit tight.";
    if (params_.fit == Fit::none && params_.cascades > 1)
      return "Cascades are fitted to the view samples of their ranges: they take fit tight or stable.";
    if (params_.filter == Filter::pcss && warped)
      return "Percentage-closer soft shadows size search and filter by the light's angle, which a warp "
             "bends.";
    if (params_.filter == Filter::evsm && params_.moment_format == MomentFormat::bits16 &&
        std::max(params_.evsm_positive, params_.evsm_negative) > 5.54F)
      return "Squares of warped depths above an exponent of 5.54 do not fit a half: lower evsm_positive and "
             "evsm_negative, or take moment_format float32.";
    return {};
  }

  std::optional<std::string> supports_light(const Case& c) const {
    const Light& light = c.frame->light;
    const bool shaped = light.kind == LightKind::rectangle || light.kind == LightKind::textured_rectangle ||
                        light.kind == LightKind::sphere;
    if (params_.filter == Filter::pcss && (!shaped || !(light.size() > 0)))
      return "Percentage-closer soft shadows need a rectangle or sphere light: the penumbra follows from its "
             "size.";
    const LightPoint point = light_point(light);
    const Box& box = c.frame->geometry.bounds;
    const Vec3f p = light.center;
    const bool inside = p.x >= box.lo.x && p.y >= box.lo.y && p.z >= box.lo.z && p.x <= box.hi.x &&
                        p.y <= box.hi.y && p.z <= box.hi.z;
    if (may_need_faces(point) && inside && (params_.warp != Warp::none || params_.cascades > 1))
      return "The light is inside the scene's bounds and may take six faces, which take neither cascades nor "
             "a warp.";
    return {};
  }

  Params params_;
  Fitter fitter_;
  DepthMaps maps_;
  MomentMaps moments_;
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
  info.sources = {"Williams1978", "Reeves1987", "Stamminger2002", "Martin2004",
                  "Wimmer2004",   "Zhang2006",  "Fernando2005",   "Donnelly2006",
                  "Peters2015",   "Lloyd2008",  "Lauritzen2008",  "Magnusson2016"};
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
