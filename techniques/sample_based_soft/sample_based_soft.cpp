#include "techniques/sample_based_soft/sample_based_soft.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "technique/illustration.h"
#include "techniques/common/mask_resolve.h"
#include "techniques/sample_based_soft/coherent_shading.h"
#include "techniques/sample_based_soft/soft_pass.h"

namespace penumbra {
namespace {

using namespace sample_based_soft;

class SampleBasedSoft final : public Technique, public Illustrated {
 public:
  explicit SampleBasedSoft(const Params& params) { state_.params = params; }

  std::optional<std::string> supports(const Case& c) const override {
    const uint32_t lanes = std::min(c.device->caps().subgroup_size, 32u);
    if (lanes < 4 || !std::has_single_bit(lanes))
      return fmt::format("sample_based_soft needs subgroups of 4 lanes or more; this device has {}.", lanes);
    if (c.light_samples->points.front().w == 0)
      return "sample_based_soft sees the scene from the light's centre; a directional light has none.";
    if (c.light_samples->move == PixelMove::wrap && state_.params.half_spaces == Params::HalfSpaces::table)
      return "a table knows one set of light samples; those that each pixel wraps around the rectangle are "
             "many. Regular grids and spheres can be rotated per pixel.";
    if (state_.params.transparency > 0) return no_transparency(c);
    return std::nullopt;
  }

  void setup(const Case& c, gpu::PassRecorder& passes) override {
    state_.set_light(c, passes);
    set_up_ = {state_.light.layout, state_.light.ball};
    casters_.setup(state_);
    lists_.setup(state_);
    coverage_.setup(state_, casters_);
    soft_.setup(state_, casters_);
    if (state_.params.coherent_shading) shading_.setup(state_);
    resolve_.setup(*c.device, state_.light.layout);
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    const Changes& changes = c.frame->changes;
    if (!built_ || changes.topology || changes.light || changes.positions) state_.set_light(c, passes);
    if (!set_up_ || *set_up_ != std::pair(state_.light.layout, state_.light.ball)) setup(c, passes);
    if (!built_ || changes.topology) {
      casters_.build_topology(state_, c.frame->geometry, passes);
      if (state_.params.coherent_shading) shading_.build(state_, c.frame->geometry, passes);
    }
    if (!built_ || changes.topology || changes.light || changes.positions)
      casters_.build_closed(state_, c, passes);
    // In light space the table stays as it is while the light keeps its samples there.
    if (!built_ || table_of_ != state_.light.samples) {
      table_.build(state_, passes);
      table_of_ = state_.light.samples;
    }
    built_ = true;
    passes.finish();
    casters_.bind(state_);
    lists_.bind(state_);
    coverage_.bind(state_, casters_);
    soft_.bind(state_, casters_, table_);
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    frame(in, passes, SoftPass::Statistics::none);
    last_ = in;
    passes_ = &passes;
  }

  Counters counters() override;
  std::vector<Illustration> illustrations() override;

  std::vector<float> cosines() override {
    return state_.params.coherent_shading && passes_ ? shading_.download(state_, *passes_)
                                                     : std::vector<float>{};
  }

  uint64_t structure_bytes() const override {
    return state_.bytes() + casters_.bytes() + lists_.bytes() + coverage_.bytes() + soft_.bytes() +
           table_.bytes() + shading_.bytes();
  }

 private:
  // Why transparent triangles cannot be weighted here, or nothing.
  std::optional<std::string> no_transparency(const Case& c) const;
  void frame(const RenderInput& in, gpu::PassRecorder& passes, SoftPass::Statistics statistics);
  void add_list_counters(Counters& out) const;

  FrameState state_;
  Casters casters_;
  SampleLists lists_;
  Coverage coverage_;
  SoftPass soft_;
  PlaneTable table_;
  MaskResolve resolve_;
  CoherentShading shading_;
  std::optional<std::pair<MaskLayout, bool>> set_up_;  // what the pipelines are made for
  std::vector<Vec4f> table_of_;
  bool built_ = false;
  RenderInput last_;
  gpu::PassRecorder* passes_ = nullptr;
};

void SampleBasedSoft::frame(const RenderInput& in, gpu::PassRecorder& passes,
                            SoftPass::Statistics statistics) {
  state_.begin(in, passes);
  lists_.run(state_, in, passes);
  casters_.prepare(state_, *in.scene_case, passes);
  soft_.reset();
  const uint32_t groups = lists_.group_count();
  if (groups > 0) {
    coverage_.count(state_, casters_, lists_, groups, passes);
    for (const Chunk& chunk : coverage_.chunks()) {
      coverage_.write(state_, casters_, lists_, chunk, passes);
      soft_.run(state_, in, casters_, lists_, coverage_, chunk, statistics, passes);
    }
  }
  if (!state_.walk_resolves())
    resolve_.run(state_.masks_address(in), in.device.mask->address(), in.device.visibility->address(),
                 state_.light.layout.weighted ? state_.weights.address() : 0, state_.pixels(), passes,
                 state_.light.layout.clustered ? state_.places.address() : 0);
  if (state_.transparent())
    passes.device_pass("resolve", [&](gpu::Commands& commands) {
      commands.barrier();
      commands.copy(state_.through, *in.device.visibility, uint64_t{state_.pixels()} * 4);
    });
  if (state_.params.coherent_shading) shading_.run(state_, in, passes);
}

std::optional<std::string> SampleBasedSoft::no_transparency(const Case& c) const {
  const MaskLayout layout = mask_layout(c.frame->light, *c.light_samples);
  if (layout.weighted)
    return "transparency weights triangles by how many light samples they cover; here samples differ in "
           "weight.";
  if (state_.params.restrict_to_penumbra)
    return "transparency needs every light sample; restrict_to_penumbra lets one stand for all.";
  if (words_per_pass(layout) < layout.words ||
      (state_.params.half_spaces == Params::HalfSpaces::table && layout.words > 32))
    return "transparency needs all light samples in one pass; these are too many.";
  return std::nullopt;
}

void SampleBasedSoft::add_list_counters(Counters& out) const {
  std::vector<uint32_t> lengths(state_.lists());
  gpu::download(*passes_, "read_counts", lists_.lengths(), lengths.data(), lengths.size() * 4);
  passes_->finish();
  double total = 0, occupied = 0, longest = 0;
  for (const double n : lengths) total += n, occupied += n > 0, longest = std::max(longest, n);
  const double all = double(state_.grid_size()) * state_.grid_size();
  out["list_length_mean"] = occupied > 0 ? total / occupied : 0;
  out["list_length_max"] = longest;
  out["occupancy"] = (occupied - (lengths.back() > 0)) / all;
  out["view_samples_listed"] = total;
  out["view_samples_outside"] = double(lengths.back());
  out["casters_per_list"] = occupied > 0 ? double(coverage_.total()) / occupied : 0;
}

// Renders the last frame again, with statistics, into the same output.
Counters SampleBasedSoft::counters() {
  Counters out;
  if (!passes_) return out;
  const double dispatches = soft_.dispatches(), hard = soft_.hard_groups();
  frame(last_, *passes_, SoftPass::Statistics::nothing_skipped);
  const Header all = state_.read_header(*passes_);
  frame(last_, *passes_, SoftPass::Statistics::as_walked);
  const Header h = state_.read_header(*passes_);
  add_list_counters(out);
  out["groups"] = double(lists_.group_count());
  out["groups_outside_penumbrae"] = hard;
  out["pairs_list_caster"] = double(coverage_.total());
  out["casters_tested"] = wide(h.tests);
  out["pairs_evaluated"] = wide(h.pairs);
  out["pairs_necessary"] = wide(all.necessary);
  out["triangles_casting"] = double(h.casters);
  out["triangles_outside_blocks"] = double(h.list_count);
  out["silhouette_edges"] = double(h.silhouettes);
  out["chunks"] = double(coverage_.chunks().size());
  out["walk_dispatches"] = dispatches;
  out["table_bytes"] = state_.params.half_spaces == Params::HalfSpaces::table ? double(table_.bytes()) : 0.0;
  return out;
}

std::vector<Illustration> SampleBasedSoft::illustrations() {
  if (!passes_ || lists_.group_count() == 0) return {};
  const auto read = [&](const gpu::Buffer& buffer, std::size_t count) {
    std::vector<uint32_t> words(count);
    gpu::download(*passes_, "read_lists", buffer, words.data(), count * 4);
    return words;
  };
  const std::size_t groups = lists_.group_count();
  const std::vector<uint32_t> lengths = read(lists_.lengths(), state_.lists()),
                              casters = read(coverage_.counts(), state_.lists()),
                              slots = read(lists_.slots(), groups * state_.lanes),
                              list_of = read(lists_.group_lists(), groups);
  passes_->finish();
  const std::vector<float> none(state_.pixels(), std::numeric_limits<float>::quiet_NaN());
  PixelFigures length{none}, tested{none};
  for (std::size_t s = 0; s < slots.size(); ++s) {
    if (slots[s] >= none.size()) continue;
    const uint32_t list = list_of[s / state_.lanes];
    length.values[slots[s]] = static_cast<float>(lengths[list]);
    tested.values[slots[s]] = static_cast<float>(casters[list]);
  }
  const auto side = static_cast<int>(state_.grid_size());
  // Lists lie tile by tile; the picture's rows are the light's view.
  const auto over_light = [&](const std::vector<uint32_t>& counts) {
    GridFigures grid{side, side, {}, {}, {}, "", ""};
    const uint32_t size = state_.grid_size(), across = (size + tile_side - 1) / tile_side;
    for (uint32_t y = 0; y < size; ++y)
      for (uint32_t x = 0; x < size; ++x)
        grid.values.push_back(
            static_cast<float>(counts[(y / tile_side * across + x / tile_side) * tile_lists +
                                      y % tile_side * tile_side + x % tile_side]));
    return grid;
  };
  return {{"list_lengths_over_light", "View samples in each list, in the light's view", over_light(lengths)},
          {"casters_over_light", "Casters whose influence region touches each list, in the light's view",
           over_light(casters)},
          {"list_length_of_view_sample", "View samples in the list of each view sample", std::move(length)},
          {"casters_per_view_sample", "Casters that each view sample may have to be tested against",
           std::move(tested)}};
}

}  // namespace

TechniqueInfo sample_based_soft_technique() {
  TechniqueInfo info;
  info.name = "sample_based_soft";
  info.title = "Sample based soft shadows with alias-free shadow maps";
  info.sources = {"Sintorn2008, sec. 4"};
  info.params = param_table().infos();
  info.lights = {LightKind::point,  LightKind::spot,   LightKind::rectangle,
                 LightKind::sphere, LightKind::volume, LightKind::textured_rectangle};
  info.sampled = true;
  info.rotates = true;
  info.make = [](const ParamValues& values) -> std::unique_ptr<Technique> {
    return std::make_unique<SampleBasedSoft>(param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
