#include "techniques/common/shadow_maps/renderer.h"

#include <fmt/format.h>

#include "techniques/common/shadow_maps/counters.h"

namespace penumbra::shadow_map {

std::optional<std::string> Renderer::supports(const Case& c) const {
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

std::optional<std::string> Renderer::supports_combination() const {
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

std::optional<std::string> Renderer::supports_light(const Case& c) const {
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

void Renderer::setup(const Case& c, gpu::PassRecorder& passes) {
  fitter_.setup(*c.device);
  maps_.setup(*c.device);
  if (params_.filterable()) moments_.setup(*c.device);
  lookup_.setup(*c.device, c.frame->light.kind == LightKind::sphere, passes);
}

void Renderer::render(const RenderInput& in, const LightPoint& light, gpu::PassRecorder& passes) {
  const Fitted& fitted = fitter_.run(*in.scene_case, light, *in.view_samples, passes);
  maps_.draw(*in.scene_case, fitted, passes);
  if (params_.filterable()) moments_.run(fitted, maps_, passes);
  lookup_.run(in, fitted, maps_, moments_, passes);
  last_ = in;
}

Counters Renderer::counters() const {
  return count(params_, fitter_.result(), maps_.image().bytes() + moments_.bytes(), last_);
}

std::vector<Illustration> Renderer::illustrations() const {
  return illustrate(params_, fitter_.result(), last_);
}

}  // namespace penumbra::shadow_map
