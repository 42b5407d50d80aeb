#include "techniques/shadow_map/shadow_map.h"

#include "techniques/common/shadow_maps/renderer.h"

namespace penumbra {
namespace shadow_map {
namespace {

class ShadowMap final : public Technique, public Illustrated {
 public:
  explicit ShadowMap(const Params& params) : renderer_(params) {}
  std::optional<std::string> supports(const Case& c) const override { return renderer_.supports(c); }
  void setup(const Case& c, gpu::PassRecorder& passes) override { renderer_.setup(c, passes); }
  // A depth map depends on the camera through its fit: all work is per frame.
  void build(const Case&, gpu::PassRecorder&) override {}
  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    renderer_.render(in, light_point(in.scene_case->frame->light), passes);
  }
  Counters counters() override { return renderer_.counters(); }
  std::vector<Illustration> illustrations() override { return renderer_.illustrations(); }
  uint64_t structure_bytes() const override { return renderer_.bytes(); }

 private:
  Renderer renderer_;
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
