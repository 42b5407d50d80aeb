#include "techniques/@name@/@name@.h"

#include <algorithm>

#include "shaders/@name@_occlude.h"
#include "techniques/common/light_emission.h"
#include "techniques/common/mask_resolve.h"
#include "techniques/@name@/params.h"
#include "techniques/@name@/shaders/shared.h"

namespace penumbra {
namespace @name@ {
namespace {

// The set of light samples as a mask holds it: one bit after the other, with nothing between.
MaskLayout plain_layout(const LightSamples& samples) {
  MaskLayout layout;
  layout.samples = layout.columns = samples.count();
  layout.words = layout.mask_words = samples.mask_words();
  layout.weighted = !samples.uniform_weights;
  return layout;
}

class @Name@ final : public Technique {
 public:
  explicit @Name@(const Params& params) : params_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    if (c.frame->geometry.triangle_count() == 0) return "The scene has no triangle.";
    return std::nullopt;
  }

  void setup(const Case& c, gpu::PassRecorder&) override {
    occlude_ = gpu::ComputePipeline(*c.device, @name@_occlude_spv, sizeof(OccludePush));
  }

  // Nothing is built of the triangles; the light's samples go to the device.
  void build(const Case& c, gpu::PassRecorder& passes) override {
    const LightSamples& samples = *c.light_samples;
    if (const MaskLayout layout = plain_layout(samples); !(layout == layout_) || !built_) {
      layout_ = layout;
      resolve_.setup(*c.device, layout_);
    }
    light_.emission = light_emission(c.frame->light).emission;
    const auto send = [&](gpu::Buffer& buffer, const void* data, std::size_t bytes) {
      gpu::ensure(buffer, *c.device, bytes, gpu::Memory::device, "@name@: light");
      gpu::upload(passes, "upload_light", buffer, data, bytes);
    };
    send(constants_, &light_, sizeof light_);
    send(points_, samples.points.data(), samples.points.size() * sizeof(Vec4f));
    send(weights_, samples.weights.data(), samples.weights.size() * sizeof(float));
    built_ = true;
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    const Case& c = *in.scene_case;
    const ViewSamples& view = *in.view_samples;
    OccludePush push{};
    push.light = constants_.address(), push.points = points_.address();
    push.positions = c.geometry->positions.address(), push.indices = c.geometry->indices.address();
    push.triangle = view.triangle().address(), push.position = view.position().address();
    push.origin = view.origin().address(), push.normal = view.geometric_normal().address();
    push.mask = in.device.mask->address();
    push.pixels = static_cast<uint32_t>(view.width()) * static_cast<uint32_t>(view.height());
    push.words = static_cast<uint32_t>(layout_.mask_words);
    push.samples = static_cast<uint32_t>(layout_.samples);
    const uint64_t groups = (uint64_t{push.pixels} * push.words + group_lanes - 1) / group_lanes;
    dispatches_ = 0;
    for (uint32_t first = 0; first < c.geometry->triangle_count; first = push.end, ++dispatches_) {
      push.first = first;
      push.end =
          std::min(first + static_cast<uint32_t>(params_.triangles_per_dispatch), c.geometry->triangle_count);
      passes.device_pass("occlude",
                         [&](gpu::Commands& commands) { commands.dispatch(occlude_, push, groups); });
    }
    resolve_.run(push.mask, push.mask, in.device.visibility->address(), weights_.address(), push.pixels,
                 passes);
  }

  Counters counters() override { return {{"dispatches", static_cast<double>(dispatches_)}}; }

  uint64_t structure_bytes() const override {
    return constants_.bytes() + points_.bytes() + weights_.bytes();
  }

 private:
  Params params_;
  gpu::ComputePipeline occlude_;
  MaskResolve resolve_;
  MaskLayout layout_;
  LightConstants light_{};
  gpu::Buffer constants_, points_, weights_;
  uint64_t dispatches_ = 0;
  bool built_ = false;
};

}  // namespace
}  // namespace @name@

TechniqueInfo @name@_technique() {
  using @name@::param_table;
  TechniqueInfo info;
  info.name = "@name@";
  info.title = "@title@";
  info.sources = {};  // keys of techniques/references.bib
  info.params = param_table().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.sampled = true;
  info.make = [](const ParamValues& values) -> std::unique_ptr<Technique> {
    return std::make_unique<@name@::@Name@>(param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
