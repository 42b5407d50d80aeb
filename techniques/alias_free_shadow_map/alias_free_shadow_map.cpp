#include "techniques/alias_free_shadow_map/alias_free_shadow_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "shaders/alias_free_resolve.h"
#include "technique/illustration.h"
#include "techniques/alias_free_shadow_map/caster_pass.h"

namespace penumbra {
namespace alias_free {
namespace {

class AliasFreeShadowMap final : public Technique, public Illustrated {
 public:
  explicit AliasFreeShadowMap(const Params& params)
      : params_(params), fitter_(params), lists_(params), casters_(params), pass_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    const uint32_t lanes = c.device->caps().subgroup_size;
    if (lanes < 4 || !std::has_single_bit(lanes))
      return fmt::format("The lists' prefix sums need subgroups of 4 lanes or more; this device has {}.",
                         lanes);
    return {};
  }

  void setup(const Case& c, gpu::PassRecorder&) override {
    fitter_.setup(c);
    lists_.setup(c);
    casters_.setup(c);
    pass_.setup(c);
    resolve_ = gpu::ComputePipeline(*c.device, alias_free_resolve_spv, sizeof(ResolvePush));
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    casters_.build(c, passes);
    pass_.build(c, casters_);
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    const LightView& view = fitter_.run(in, passes);
    const auto pixels = static_cast<uint32_t>(in.view_samples->width() * in.view_samples->height());
    lists_.run(pixels, view, fitter_, casters_.away(), pass_.progress(), passes);
    pass_.run(casters_, fitter_, lists_, passes);
    resolve(in, passes);
    last_ = in;
  }

  Counters counters() override;
  std::vector<Illustration> illustrations() override;

  uint64_t structure_bytes() const override {
    return fitter_.bytes() + lists_.bytes() + casters_.bytes() + pass_.bytes();
  }

 private:
  void resolve(const RenderInput& in, gpu::PassRecorder& passes);

  Params params_;
  Fitter fitter_;
  SampleLists lists_;
  Casters casters_;
  CasterPass pass_;
  gpu::ComputePipeline resolve_;
  RenderInput last_;
};

void AliasFreeShadowMap::resolve(const RenderInput& in, gpu::PassRecorder& passes) {
  ResolvePush push{};
  push.slots = lists_.slots().address();
  push.blocked = lists_.blocked().address();
  push.visibility = in.device.visibility->address();
  push.count = static_cast<uint32_t>(in.view_samples->width() * in.view_samples->height());
  passes.device_pass("resolve", [&](gpu::Commands& commands) {
    commands.dispatch(resolve_, push, (uint64_t{push.count} + group_lanes - 1) / group_lanes);
  });
}

Counters AliasFreeShadowMap::counters() {
  Counters out;
  if (!last_.view_samples) return out;
  gpu::PassRecorder passes(*last_.scene_case->device);
  std::vector<uint32_t> lengths(lists_.texels());
  if (!lengths.empty())
    gpu::download(passes, "download", lists_.lengths(), lengths.data(), lengths.size() * 4);
  passes.finish();
  double total = 0, occupied = 0, longest = 0;
  for (const double n : lengths) total += n, occupied += n > 0, longest = std::max(longest, n);
  out["list_length_mean"] = occupied > 0 ? total / occupied : 0;
  out["list_length_max"] = longest;
  out["occupancy"] = lengths.empty() ? 0 : occupied / static_cast<double>(lengths.size());
  out["lists_occupied"] = occupied;
  out["view_samples_listed"] = total;
  out["list_bytes"] = static_cast<double>(lists_.list_bytes());
  out["faces"] = lists_.texels() > static_cast<uint32_t>(params_.grid_size * params_.grid_size) ? 6.0 : 1.0;
  out["pairs_tested"] = pass_.count_pairs(casters_, fitter_, lists_, passes);
  return out;
}

std::vector<Illustration> AliasFreeShadowMap::illustrations() {
  if (!last_.view_samples || lists_.texels() == 0) return {};
  gpu::PassRecorder passes(*last_.scene_case->device);
  const auto read = [&](const gpu::Buffer& buffer, std::size_t count) {
    std::vector<uint32_t> words(count);
    gpu::download(passes, "download", buffer, words.data(), count * 4);
    return words;
  };
  const std::vector<uint32_t> lengths = read(lists_.lengths(), lists_.texels()),
                              offsets = read(lists_.offsets(), lists_.texels()),
                              slots = read(lists_.slots(), last_.view_samples->host().pixel_count());
  passes.finish();
  PixelFigures seen{std::vector<float>(slots.size(), std::numeric_limits<float>::quiet_NaN())};
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i] == no_slot) continue;
    // The last list that begins at or before the view sample's place; empty lists begin where the next does.
    const auto list = std::upper_bound(offsets.begin(), offsets.end(), slots[i]) - offsets.begin() - 1;
    seen.values[i] = static_cast<float>(lengths[static_cast<std::size_t>(list)]);
  }
  const int side = params_.grid_size, faces = static_cast<int>(lists_.texels()) / (side * side);
  return {{"list_lengths_over_light", "View samples in each list, in the light's view",
           GridFigures{side, side * faces, {lengths.begin(), lengths.end()}, {}, {}, "", ""}},
          {"list_length_of_view_sample", "View samples in the list of each view sample", std::move(seen)}};
}

}  // namespace
}  // namespace alias_free

TechniqueInfo alias_free_shadow_map_technique() {
  using alias_free::param_table;
  TechniqueInfo info;
  info.name = "alias_free_shadow_map";
  info.title = "Alias-free shadow maps";
  info.sources = {"Sintorn2008, sec. 3", "Aila2004", "Johnson2005"};
  info.params = param_table().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.sampled = false;
  info.residence = Residence::device;
  info.origin = [](const ParamValues& values) { return param_table().read(values).origin; };
  info.make = [](const ParamValues& values) {
    return std::make_unique<alias_free::AliasFreeShadowMap>(param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
