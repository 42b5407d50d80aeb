#include "techniques/depth_complexity_sampling/depth_complexity_sampling.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>

#include "core/parallel.h"
#include "embree/flush_denormals.h"
#include "techniques/common/exact_choice.h"
#include "techniques/depth_complexity_sampling/params.h"
#include "techniques/depth_complexity_sampling/view_groups.h"

namespace penumbra {
namespace {

using namespace depth_complexity;

class DepthComplexitySampling final : public Technique {
 public:
  explicit DepthComplexitySampling(const DepthComplexityParams& params) : params_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    const Geometry& g = c.frame->geometry;
    if (g.triangle_count() == 0) return "The scene has no triangle.";
    if (static_cast<std::size_t>(c.light_samples->count()) > most_samples)
      return fmt::format("Depth complexity sampling takes at most {} light samples; these are {}.",
                         most_samples, c.light_samples->count());
    return light_space_fails(c.frame->light, *c.light_samples, g.bounds);
  }

  void build(const Case& c, gpu::PassRecorder& passes) override {
    const Geometry& g = c.frame->geometry;
    const bool moved = c.frame->changes.positions || params_.dynamic;
    const bool fits = hierarchy_ && hierarchy_->fits(g);
    const bool topology = !fits || (c.frame->changes.topology && !params_.dynamic);
    if (topology) {
      passes.host_pass("find_edges", [&] { topology_ = find_edges(g); });
      passes.host_pass("copy_geometry", [&] { load(g); });
    } else if (moved) {
      passes.host_pass("check_welds", [&] {
        if (!still_welded(topology_, g)) topology_ = find_edges(g);
      });
      passes.host_pass("copy_vertices", [&] { hierarchy_->move(g); });
    }
    if (topology || moved) passes.host_pass("build_hierarchy", [&] { hierarchy_->commit(); });
    passes.host_pass("order_light_samples", [&] {
      light_ = make_light_space(c.frame->light, *c.light_samples, g.bounds);
      judge_.assign(c.frame->light, *c.light_samples, light_);
    });
  }

  void render(const RenderInput& in, gpu::PassRecorder& passes) override {
    const std::vector<Vec3f>& positions = in.scene_case->frame->geometry.positions;
    struct Call {
      DepthComplexitySampling& self;
      const RenderInput& in;
      const std::vector<Vec3f>& positions;
    } const call{*this, in, positions};
    passes.host_pass("move_vertices", [&call] {
      call.self.silhouettes_.move_vertices(call.self.topology_, call.positions, call.self.light_);
    });
    passes.host_pass("face_planes",
                     [&call] { call.self.silhouettes_.find_planes(call.self.topology_, call.self.light_); });
    passes.host_pass("potential_silhouettes",
                     [&call] { call.self.silhouettes_.choose_edges(call.self.topology_); });
    passes.host_pass("blocks",
                     [&call] { call.self.silhouettes_.fill_blocks(call.self.topology_, call.self.light_); });
    passes.host_pass("tree", [&call] { call.self.silhouettes_.build_tree(call.self.light_); });
    passes.host_pass("masks", [&call] { call.self.masks(call.in); });
  }

  Counters counters() override;
  uint64_t structure_bytes() const override {
    uint64_t b =
        topology_.bytes() + silhouettes_.bytes() + judge_.bytes() + (hierarchy_ ? hierarchy_->bytes() : 0);
    for (const Scratch& s : scratch_) b += s.bytes();
    return b;
  }

 private:
  void load(const Geometry& g) {
    const HierarchyQuality quality = params_.dynamic ? HierarchyQuality::medium : HierarchyQuality::high;
    hierarchy_ = std::make_unique<EmbreeHierarchy>(quality, params_.dynamic, true);
    hierarchy_->load(g);
  }

  void masks(const RenderInput& in);

  DepthComplexityParams params_;
  EdgeTopology topology_;
  std::unique_ptr<EmbreeHierarchy> hierarchy_;
  LightSpace light_;
  Silhouettes silhouettes_;
  RayJudge judge_;
  std::vector<Scratch> scratch_;
  WorkCounts counts_;
};

// Workers take tiles from one counter: their scratch is then theirs, whichever thread runs them.
void DepthComplexitySampling::masks(const RenderInput& in) {
  const ViewSamplesHost& view = in.view_samples->host();
  judge_.bind(*hierarchy_, view, in.host.visibility, in.host.mask);
  scratch_.resize(static_cast<std::size_t>(thread_count()));
  for (Scratch& s : scratch_) s.counts = {};
  struct Work {
    DepthComplexitySampling& self;
    const ViewSamplesHost& view;
    std::size_t tiles;
    std::atomic<std::size_t> next{0};
  } work{*this, view, tile_count(view)};
  parallel_for(scratch_.size(), 1, [&work](std::size_t worker, std::size_t) {
    const embree::FlushDenormals flush;
    DepthComplexitySampling& self = work.self;
    const Occluders occluders{&self.light_, &self.silhouettes_, &self.judge_};
    Scratch& scratch = self.scratch_[worker];
    for (std::size_t tile = work.next++; tile < work.tiles; tile = work.next++) {
      ViewPoint points[tile_pixels];
      const std::size_t count =
          gather_tile(work.view, tile, self.light_, self.judge_, points, scratch.counts);
      for (std::size_t g = 0; g < count; g += large_group)
        find_candidates(occluders, points + g, std::min(large_group, count - g), scratch);
    }
  });
  counts_ = {};
  for (const Scratch& s : scratch_) counts_.add(s.counts);
  // Which worker meets the longest lists differs from frame to frame: all get the same room.
  for (Scratch& s : scratch_) scratch_.front().grow_like(s);
  for (Scratch& s : scratch_) s.grow_like(scratch_.front());
}

Counters DepthComplexitySampling::counters() {
  const auto per_sample = [&](uint64_t n) {
    return counts_.view_samples ? static_cast<double>(n) / static_cast<double>(counts_.view_samples) : 0.0;
  };
  return {{"edges", static_cast<double>(topology_.edges.size())},
          {"open_edges", static_cast<double>(topology_.open)},
          {"inconsistent_edges", static_cast<double>(topology_.inconsistent)},
          {"non_manifold_edges", static_cast<double>(topology_.non_manifold)},
          {"potential_silhouette_edges", static_cast<double>(silhouettes_.potential())},
          {"potential_silhouette_share",
           topology_.edges.empty()
               ? 0.0
               : static_cast<double>(silhouettes_.potential()) / static_cast<double>(topology_.edges.size())},
          {"topology_bytes", static_cast<double>(topology_.bytes())},
          {"silhouette_bytes", static_cast<double>(silhouettes_.bytes())},
          {"bvh_bytes", hierarchy_ ? static_cast<double>(hierarchy_->bytes()) : 0.0},
          {"view_samples", static_cast<double>(counts_.view_samples)},
          {"edges_tested_per_view_sample", per_sample(counts_.edges_tested)},
          {"silhouette_edges_per_view_sample", per_sample(counts_.crossings)},
          {"view_samples_without_edge", static_cast<double>(counts_.unparted)},
          {"view_samples_with_wide_counters", static_cast<double>(counts_.wide)},
          {"view_samples_traced", static_cast<double>(counts_.traced)},
          {"tree_nodes_visited", static_cast<double>(counts_.nodes)},
          {"blocks_entered", static_cast<double>(counts_.blocks_entered)},
          {"rays", static_cast<double>(counts_.rays)},
          {"extra_rays", static_cast<double>(counts_.extra_rays)},
          {"vector_lanes", static_cast<double>(vector_lanes())}};
}

}  // namespace

TechniqueInfo depth_complexity_sampling_technique() {
  TechniqueInfo info;
  info.name = "depth_complexity_sampling";
  info.title = "Depth complexity sampling from potential silhouette edges";
  info.sources = {"Laine2005", "Forest2008"};
  info.params = depth_complexity_params().infos();
  info.lights = {LightKind::point,  LightKind::spot,  LightKind::rectangle, LightKind::textured_rectangle,
                 LightKind::sphere, LightKind::volume};
  info.choosing = exact_choice_in_words();
  info.sampled = true;
  info.residence = Residence::host;
  info.rebuild_each_frame = [](const ParamValues& values) {
    return depth_complexity_params().read(values).dynamic;
  };
  info.make = [](const ParamValues& values) -> std::unique_ptr<Technique> {
    return std::make_unique<DepthComplexitySampling>(depth_complexity_params().read(values));
  };
  return info;
}

}  // namespace penumbra
