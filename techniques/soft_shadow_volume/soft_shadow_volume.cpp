#include "techniques/soft_shadow_volume/soft_shadow_volume.h"

#include "techniques/soft_shadow_volume/casters.h"
#include "techniques/soft_shadow_volume/illustrations.h"
#include "techniques/soft_shadow_volume/wedge_pass.h"

namespace penumbra {
namespace soft_shadow_volume {
namespace {

class SoftShadowVolume final : public Technique, public Illustrated {
 public:
  explicit SoftShadowVolume(const Params& params) : params_(params), wedges_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    if (!c.device->caps().depth_clamp)
      return "The device cannot clamp depth, which keeps the far ends of wedges at infinity.";
    if (!sums_supported(*c.device))
      return "The device cannot add up pairs of floats in a picture, in which coverage is summed.";
    if (c.device->caps().subgroup_size < 4)
      return "Silhouettes are listed by prefix sums, which need subgroups of 4 lanes or more.";
    if (params_.split > 1 && c.frame->light.kind == LightKind::sphere)
      return "A sphere is seen as the disc that faces the view sample, which is not split.";
    if (params_.coverage == Coverage::table && c.frame->light.kind == LightKind::textured_rectangle)
      return "The tables hold areas of an even light: textures take coverage: analytic.";
    const Geometry& g = c.frame->geometry;
    if (g.closed) return {};
    const std::string refusal =
        find_casters(g, build_adjacency(g.positions, g.indices), c.frame->light).refusal;
    if (!refusal.empty()) return refusal;
    return {};
  }

  void setup(const Case& c, gpu::PassRecorder& passes) override {
    silhouettes_.setup(*c.device);
    wedges_.setup(*c.device, shape_of(c.frame->light.kind), passes);
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    silhouettes_.build(c, passes);
    wedges_.set_light(*c.device, c.frame->light, passes);
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    last_ = in;
    wedges_.begin(in, passes);
    bool first = true;
    for (const Part& part : parts_of(in.scene_case->frame->light, params_.split)) {
      silhouettes_.extract(*in.scene_case, part, passes);
      wedges_.run(in, silhouettes_, part, first, passes);
      first = false;
    }
  }

  // Draws the last frame's wedges again, into counts.
  Counters counters() override {
    gpu::PassRecorder passes(*last_.scene_case->device);
    WedgeCounts sum;
    double edges = 0, near_caps = 0, eye = 0;
    for (const Part& part : parts_of(last_.scene_case->frame->light, params_.split)) {
      silhouettes_.extract(*last_.scene_case, part, passes);
      edges += silhouettes_.count(), near_caps += silhouettes_.near_caps() / 3;
      eye = std::max(eye, double(silhouettes_.eye_volumes()));
      const WedgeCounts c = wedges_.count(last_, silhouettes_, part, passes);
      sum.fragments += c.fragments, sum.pixels += c.pixels, sum.whole_picture += c.whole_picture;
    }
    return {{"edges", double(silhouettes_.edges())},
            {"silhouette_edges", edges},
            {"wedge_fragments", sum.fragments},
            {"wedge_pixels", sum.pixels},
            {"whole_picture_wedges", sum.whole_picture},
            {"near_caps", near_caps},
            {"eye_volumes", eye}};
  }

  std::vector<Illustration> illustrations() override {
    if (!last_.scene_case) return {};
    gpu::PassRecorder passes(*last_.scene_case->device);
    return illustrate(wedges_, silhouettes_, parts_of(last_.scene_case->frame->light, params_.split), last_,
                      passes);
  }

  uint64_t structure_bytes() const override { return silhouettes_.bytes() + wedges_.bytes(); }

 private:
  Params params_;
  Silhouettes silhouettes_;
  WedgePass wedges_;
  RenderInput last_;
};

}  // namespace
}  // namespace soft_shadow_volume

TechniqueInfo soft_shadow_volume_technique() {
  using soft_shadow_volume::param_table;
  TechniqueInfo info;
  info.name = "soft_shadow_volume";
  info.title = "Soft shadow volumes";
  info.sources = {"SoftShadowVolumes", "Assarsson2003"};
  info.params = param_table().infos();
  info.lights = {LightKind::point, LightKind::rectangle, LightKind::sphere, LightKind::textured_rectangle};
  info.sampled = false;
  info.sphere_as_disc = true;
  info.residence = Residence::device;
  // It works at P itself; what a surface hides from its own points follows from its topology, as for P' just
  // off it.
  info.origin = [](const ParamValues&) { return Origin::offset; };
  info.make = [](const ParamValues& values) {
    return std::make_unique<soft_shadow_volume::SoftShadowVolume>(param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
