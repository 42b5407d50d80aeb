#include "techniques/gears/gears.h"

#include <fmt/format.h>

#include <bit>

#include "technique/illustration.h"
#include "techniques/common/exact_choice.h"
#include "techniques/common/mask_resolve.h"
#include "techniques/gears/cells.h"
#include "techniques/gears/clusters.h"
#include "techniques/gears/cpu_backend.h"

namespace penumbra {
namespace {

using namespace gears;

constexpr int most_light_samples = 4096;

class Gears final : public Technique, public Illustrated {
 public:
  explicit Gears(const GearsParams& params) : params_(params) { state_.params = params; }

  std::optional<std::string> supports(const Case& c) const override {
    const uint32_t lanes = lanes_of(*c.device);
    if (lanes < 4 || !std::has_single_bit(lanes))
      return fmt::format("gears needs subgroups of 4 lanes or more; this device has {}.", lanes);
    if (c.light_samples->move != PixelMove::none && !is_regular_grid(c.frame->light, *c.light_samples))
      return "gears moves regular grids of light samples per pixel, up to 64 x 64 on a rectangle, and no "
             "other sets.";
    if (c.light_samples->count() > most_light_samples)
      return fmt::format("gears takes at most {} light samples; these are {}.", most_light_samples,
                         c.light_samples->count());
    return std::nullopt;
  }

  void setup(const Case& c, gpu::PassRecorder& passes) override {
    state_.set_light(c, passes);
    ready_ = state_.layout;
    resolve_.setup(*state_.device, state_.layout);
    clusters() ? clusters_.setup(state_) : cells_.setup(state_);
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    const Changes& changes = c.frame->changes;
    if (!built_ || changes.topology || changes.light || changes.positions) state_.set_light(c, passes);
    if (!ready_ || *ready_ != state_.layout) setup(c, passes);
    if (!built_ || changes.topology)
      clusters() ? clusters_.build(state_, c.frame->geometry, passes)
                 : cells_.build(state_, c.frame->geometry, passes);
    built_ = true;
    passes.finish();
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    clusters() ? clusters_.render(state_, in, passes) : cells_.render(state_, in, passes);
    resolve(in, passes);
    last_ = in;
    passes_ = &passes;
  }

  // Renders the last frame again, with statistics, into the same output.
  Counters counters() override {
    Counters c;
    if (!passes_) return c;
    clusters() ? clusters_.count(state_, last_, *passes_, c) : cells_.count(state_, last_, *passes_, c);
    resolve(last_, *passes_);
    passes_->finish();
    c["structure_bytes"] = static_cast<double>(structure_bytes());
    return c;
  }

  // Of the grid; clusters have none.
  std::vector<Illustration> illustrations() override {
    if (!passes_ || clusters()) return {};
    return cells_.illustrations(state_, last_, *passes_);
  }

  uint64_t structure_bytes() const override { return state_.bytes() + clusters_.bytes() + cells_.bytes(); }

 private:
  void resolve(const RenderInput& in, gpu::PassRecorder& passes) const {
    if (state_.walk_resolves()) return;
    resolve_.run(state_.masks_address(in), in.device.mask->address(), in.device.visibility->address(),
                 state_.layout.weighted ? state_.weights.address() : 0, state_.pixels(), passes);
  }
  bool clusters() const { return params_.assignment == GearsParams::Assignment::clusters; }

  GearsParams params_;
  FrameState state_;
  std::optional<MaskLayout> ready_;  // what the pipelines are made for
  bool built_ = false;
  RenderInput last_;
  gpu::PassRecorder* passes_ = nullptr;
  MaskResolve resolve_;
  Clusters clusters_;
  Cells cells_;
};

}  // namespace

TechniqueInfo gears_technique() {
  TechniqueInfo info;
  info.name = "gears";
  info.title = "GEARS: visibility masks rasterised per view sample";
  info.sources = {"GEARS"};
  info.params = gears_params().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.choosing = exact_choice_in_words();
  info.sampled = true;
  info.rotates = true;
  const auto on_host = [](const ParamValues& values) {
    return gears_params().read(values).backend == GearsParams::Backend::cpu;
  };
  info.residence_of = [on_host](const ParamValues& values) {
    return on_host(values) ? Residence::host : Residence::device;
  };
  info.make = [on_host](const ParamValues& values) -> std::unique_ptr<Technique> {
    if (on_host(values)) return cpu::make_backend(gears_params().read(values));
    return std::make_unique<Gears>(gears_params().read(values));
  };
  return info;
}

}  // namespace penumbra
