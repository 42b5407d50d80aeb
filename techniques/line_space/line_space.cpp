#include "techniques/line_space/line_space.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "techniques/line_space/device_tracer.h"
#include "techniques/line_space/host_tracer.h"

namespace penumbra {
namespace line_space {
namespace {

constexpr double most_leaves = 4096;         // a side: places in the tree are exact in floats
constexpr int most_light_samples = 1 << 15;  // turns of one loop that some drivers allow

class LineSpace final : public Technique {
 public:
  explicit LineSpace(const Params& params) : params_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    const double leaves = std::pow(params_.branching, params_.depth);
    if (leaves > most_leaves)
      return fmt::format(
          "line_space takes trees of up to {} leaves a side; branching {} and depth {} make {}.", most_leaves,
          params_.branching, params_.depth, leaves);
    if (c.light_samples->count() > most_light_samples)
      return fmt::format("line_space takes at most {} light samples; these are {}.", most_light_samples,
                         c.light_samples->count());
    return std::nullopt;
  }

  void setup(const Case& c, gpu::PassRecorder& passes) override {
    const auto branching = static_cast<uint32_t>(params_.branching);
    passes.host_pass("shaft_table", [&] { table_ = ShaftTable(branching); });
    if (device_build()) device_tree_.setup(*c.device, branching);
    if (!cpu()) tracer_.setup(*c.device, branching, static_cast<uint32_t>(params_.depth), params_.start);
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    const Geometry& geometry = c.frame->geometry;
    const Changes& changes = c.frame->changes;
    const uint32_t faces = params_.bounding_faces ? 0 : faces_before_light(geometry.bounds, *c.light_samples);
    if (built_ && !changes.topology && !changes.positions && faces == faces_) return;
    faces_ = faces;
    std::vector<uint32_t> casters;
    passes.host_pass("select_casters", [&] {
      casters = select_casters(geometry, faces_);
      grid_ = make_grid(geometry, casters, params_);
    });
    casters_ = casters.size(), triangles_ = geometry.triangle_count();
    if (device_build()) {
      device_tree_.build(*c.geometry, casters, grid_, table_, params_.memory_limit_mib, passes);
      if (cpu()) pools_ = device_tree_.download(grid_, passes);
    } else {
      passes.host_pass("build_tree", [&] {
        pools_ = build_tree(geometry, casters, grid_, table_, params_.memory_limit_mib);
      });
      if (!cpu()) device_tree_.upload(pools_, passes);
    }
    level_begin_ = device_build() ? device_tree_.level_begin() : pools_.level_begin;
    if (!cpu()) pools_ = {}, tracer_.bind(device_tree_);
    built_ = true;
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    if (!cpu()) return tracer_.run(in, grid_, device_tree_, passes);
    const ViewSamplesHost& view = in.view_samples->host();
    const LightSamples& samples = *in.scene_case->light_samples;
    mask_.resize(view.pixel_count() * static_cast<std::size_t>(samples.mask_words()));
    visibility_.resize(view.pixel_count());
    passes.host_pass("trace", [&] {
      HostTracer(pools_, grid_, params_.start)
          .run(in.scene_case->frame->light, samples, view, mask_, visibility_);
    });
    gpu::upload(passes, "upload_result", *in.device.mask, mask_.data(), mask_.size() * sizeof(uint32_t));
    gpu::upload(passes, "upload_result", *in.device.visibility, visibility_.data(),
                visibility_.size() * sizeof(float));
  }

  Counters counters() override {
    Counters out;
    if (!built_) return out;
    const PoolBytes bytes = pool_bytes(grid_.branching, level_begin_.back());
    std::vector<double> per_level;
    for (std::size_t l = 0; l + 1 < level_begin_.size(); ++l)
      per_level.push_back(double(level_begin_[l + 1]) - double(level_begin_[l]));
    out["nodes"] = double(level_begin_.back());
    out["nodes_per_level"] = per_level;
    out["tree_bytes"] = double(bytes.tree);
    out["node_bytes"] = double(bytes.nodes);
    out["line_space_bytes"] = double(bytes.line_space);
    out["pool_bytes"] = double(bytes.total());
    out["casters"] = double(casters_);
    out["triangles_left_out"] = double(triangles_ - casters_);
    return out;
  }

  uint64_t structure_bytes() const override {
    return device_tree_.bytes() + tracer_.bytes() + pools_.tree.size() * 4 +
           pools_.nodes.size() * sizeof(Node) + pools_.line_space.size() * 4;
  }

 private:
  bool cpu() const { return params_.backend == Params::Backend::cpu; }
  bool device_build() const { return params_.build == Params::Build::device; }

  Params params_;
  ShaftTable table_;
  Grid grid_;
  Pools pools_;  // on the host while it follows segments
  DeviceTree device_tree_;
  DeviceTracer tracer_;
  std::vector<uint32_t> level_begin_;
  std::vector<uint32_t> mask_;
  std::vector<float> visibility_;
  std::size_t casters_ = 0, triangles_ = 0;
  uint32_t faces_ = 0;
  bool built_ = false;
};

}  // namespace
}  // namespace line_space

TechniqueInfo line_space_technique() {
  using line_space::param_table;
  TechniqueInfo info;
  info.name = "line_space";
  info.title = "Line space: precomputed visibility of shafts";
  info.sources = {"Keul2017"};
  info.params = param_table().infos();
  info.lights = {LightKind::point,  LightKind::directional,        LightKind::spot,  LightKind::rectangle,
                 LightKind::sphere, LightKind::textured_rectangle, LightKind::volume};
  info.sampled = true;
  info.make = [](const ParamValues& values) -> std::unique_ptr<Technique> {
    return std::make_unique<line_space::LineSpace>(param_table().read(values));
  };
  return info;
}

}  // namespace penumbra
