#include "techniques/planar_shadow/planar_shadow.h"

#include "techniques/planar_shadow/params.h"
#include "techniques/planar_shadow/projector.h"

namespace penumbra {
namespace planar_shadow {
namespace {

class PlanarShadow final : public Technique {
 public:
  explicit PlanarShadow(const Params& params) : params_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    if (std::optional<std::string> reason = missing(*c.device)) return reason;
    const auto found = find_receiver(c.frame->geometry, params_.receiver);
    if (const auto* reason = std::get_if<std::string>(&found)) return *reason;
    return {};
  }

  void setup(const Case& c, gpu::PassRecorder&) override { projector_.setup(*c.device); }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    const Changes& changes = c.frame->changes;
    if (built_ && !changes.topology && !changes.positions) return;
    passes.host_pass("find_receiver", [&] {
      const auto found = find_receiver(c.frame->geometry, params_.receiver);
      if (const auto* reason = std::get_if<std::string>(&found)) throw PointError(*reason);
      receiver_ = std::get<Receiver>(found);
    });
    projector_.build(c, receiver_, passes);
    built_ = true;
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    projector_.run(in, receiver_, passes);
    last_ = in;
  }

  Counters counters() override {
    Counters out;
    if (!last_.view_samples) return out;
    double received = 0;
    for (uint8_t e : evaluated_mask()) received += e;
    out["receiver_instance"] = double(receiver_.instance);
    out["receiver_pixels"] = received;
    out["occluder_triangles"] = double(projector_.occluder_triangles());
    return out;
  }

  uint64_t structure_bytes() const override { return projector_.bytes(); }

  std::vector<uint8_t> evaluated_mask() override {
    if (!last_.view_samples) return {};
    const ViewSamplesHost& view = last_.view_samples->host();
    const Geometry& g = last_.scene_case->frame->geometry;
    std::vector<uint8_t> mask(view.pixel_count(), 0);
    for (std::size_t i = 0; i < mask.size(); ++i)
      mask[i] =
          view.triangle[i] != no_triangle && g.triangle_instance[view.triangle[i]] == receiver_.instance;
    return mask;
  }

 private:
  Params params_;
  Projector projector_;
  Receiver receiver_;
  RenderInput last_;
  bool built_ = false;
};

}  // namespace
}  // namespace planar_shadow

TechniqueInfo planar_shadow_technique() {
  using planar_shadow::param_table;
  TechniqueInfo info;
  info.name = "planar_shadow";
  info.title = "Planar projected shadows";
  info.sources = {"Magnusson2016", "Blinn1988", "Heckbert1997"};
  info.params = param_table().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.sampled = true;
  info.residence = Residence::device;
  info.origin = [](const ParamValues&) { return Origin::exact; };
  info.make = [](const ParamValues& values) {
    return std::make_unique<planar_shadow::PlanarShadow>(param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
