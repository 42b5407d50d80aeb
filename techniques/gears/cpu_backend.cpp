#include "techniques/gears/cpu_backend.h"

#include <fmt/format.h>

#include <atomic>

#include "core/parallel.h"
#include "embree/flush_denormals.h"
#include "techniques/gears/cpu_cell_lists.h"
#include "techniques/gears/cpu_groups.h"
#include "techniques/gears/cpu_triangles.h"
#include "techniques/gears/light_setup.h"

namespace penumbra::gears::cpu {
namespace {

constexpr int most_light_samples = 4096;

class Backend final : public Technique {
 public:
  explicit Backend(const GearsParams& params) : params_(params) {}

  std::optional<std::string> supports(const Case& c) const override {
    if (c.light_samples->count() > most_light_samples)
      return fmt::format("gears takes at most {} light samples; these are {}.", most_light_samples,
                         c.light_samples->count());
    if (c.light_samples->move != PixelMove::none)
      return "the CPU backend of gears takes one set of light samples for all pixels, not one that each "
             "pixel "
             "moves; backend=vulkan moves regular grids.";
    return std::nullopt;
  }
  void build(const Case& c, gpu::PassRecorder& passes) override;
  void render(const RenderInput& in, gpu::PassRecorder& passes) override;
  Counters counters() override;
  uint64_t structure_bytes() const override;

 private:
  bool clusters() const { return params_.assignment == GearsParams::Assignment::clusters; }
  void set_light(const Case& c);
  void masks();
  void work(Scratch& scratch, CellLists::Worker& lists);
  void do_row(std::size_t row, Scratch& scratch, CellLists::Worker& lists);
  void do_cell(std::size_t cell, std::size_t triangles, Scratch& scratch);

  GearsParams params_;
  bool built_ = false;
  FrameConstants constants_{};
  LightView light_;
  MaskOutput output_;
  Triangles triangles_;
  Grid grid_;
  float slack_ = 0;
  const Geometry* geometry_ = nullptr;  // of the frame
  std::vector<Scratch> scratch_;
  std::vector<CellLists::Worker> lists_;
  std::atomic<std::size_t> next_{0};
  WorkCounts counts_;
};

void Backend::set_light(const Case& c) {
  const Light& light = c.frame->light;
  const LightSamples& samples = *c.light_samples;
  const Box& bounds = c.frame->geometry.bounds;
  const MaskLayout layout = mask_layout(light, samples);
  constants_ = frame_constants(light, samples, layout, bounds, params_.extrusion_length);
  slack_ = 2 * relative_offset * bounds.diagonal();
  output_.set_light(light, samples, layout);
  light_ = {};
  light_.grid = layout.grid, light_.infinite = layout.infinite;
  light_.columns = layout.columns, light_.rows = layout.rows;
  light_.parts = layout.grid && layout.columns > 32 ? 2 : 1;
  light_.samples = samples.points.size();
  light_.pad = constants_.pad;
  if (layout.grid) return;
  light_.lo = constants_.light_lo.xyz(), light_.hi = constants_.light_hi.xyz();
  const Vec3f origin = layout.infinite ? Vec3f{} : constants_.light.origin.xyz();
  for (std::size_t i = 0; i < (light_.samples + 31) / 32 * 32; ++i) {
    const Vec3f p = samples.points[std::min(i, light_.samples - 1)].xyz() - origin;
    light_.x.push_back(p.x), light_.y.push_back(p.y), light_.z.push_back(p.z);
  }
}

void Backend::build(const Case& c, gpu::PassRecorder& passes) {
  const Changes& changes = c.frame->changes;
  if (!built_ || changes.topology || changes.light || changes.positions)
    passes.host_pass("set_light", [&] { set_light(c); });
  if (!built_ || changes.topology)
    passes.host_pass("order_triangles",
                     [&] { triangles_.order(c.frame->geometry, clusters(), params_.triangle_order); });
  built_ = true;
}

void Backend::render(const RenderInput& in, gpu::PassRecorder& passes) {
  geometry_ = &in.scene_case->frame->geometry;
  struct Call {
    Backend& self;
    const RenderInput& in;
  } const call{*this, in};
  output_.bind(in.view_samples->host(), in.host.visibility, in.host.mask);
  passes.host_pass("move_vertices", [&call] {
    call.self.triangles_.move_vertices(*call.self.geometry_, call.self.constants_);
  });
  passes.host_pass("bin_samples", [&call] {
    call.self.grid_.assign(call.self.constants_, call.in.view_samples->host(), call.self.slack_,
                           call.self.params_.grid_size, call.self.output_);
  });
  if (clusters()) {
    passes.host_pass("fill_blocks", [&call] { call.self.triangles_.fill_blocks(*call.self.geometry_); });
    passes.host_pass("refit", [&call] { call.self.triangles_.refit(); });
  } else {
    passes.host_pass("bin_triangles", [&call] {
      call.self.triangles_.find_cells(*call.self.geometry_, call.self.constants_, call.self.grid_);
    });
  }
  passes.host_pass("masks", [&call] { call.self.masks(); });
}

// Workers take rows of cells from one counter: their scratch is then theirs, whichever thread runs them.
void Backend::masks() {
  scratch_.resize(static_cast<std::size_t>(thread_count()));
  lists_.resize(scratch_.size());
  for (Scratch& s : scratch_) s.counts = {};
  for (CellLists::Worker& l : lists_) l.assignments = l.most = 0;
  next_ = 0;
  parallel_for(scratch_.size(), 1, [this](std::size_t worker, std::size_t) {
    const embree::FlushDenormals flush;
    work(scratch_[worker], lists_[worker]);
  });
  counts_ = {};
  for (const Scratch& s : scratch_) counts_.add(s.counts);
  // Which worker meets the longest lists differs from frame to frame: all get the same room.
  for (Scratch& s : scratch_) scratch_.front().grow_like(s);
  for (Scratch& s : scratch_) s.grow_like(scratch_.front());
  for (CellLists::Worker& l : lists_) lists_.front().grow_like(l);
  for (CellLists::Worker& l : lists_) l.grow_like(lists_.front());
}

void Backend::work(Scratch& scratch, CellLists::Worker& lists) {
  // Rows of cells from the grid's two ends in turn, as those that cost much are neighbours; then the cell of
  // what has no place on the grid.
  const auto rows = static_cast<std::size_t>(params_.grid_size);
  for (std::size_t n = next_++; n <= rows; n = next_++)
    do_row(n == rows ? rows : n % 2 == 0 ? n / 2 : rows - 1 - n / 2, scratch, lists);
}

void Backend::do_row(std::size_t row, Scratch& scratch, CellLists::Worker& lists) {
  const auto size = static_cast<std::size_t>(params_.grid_size);
  if (row == size) return do_cell(size * size, 0, scratch);
  if (clusters()) {
    for (std::size_t x = 0; x < size; ++x) do_cell(row * size + x, 0, scratch);
    return;
  }
  const std::size_t budget =
      static_cast<std::size_t>(params_.list_budget_mib) * (1 << 20) / sizeof(uint32_t) / scratch_.size();
  lists.count(triangles_.cells(), row, size);
  for (std::size_t begin = 0; begin < size;) {
    const std::size_t end = lists.fill(triangles_.cells(), begin, budget);
    for (std::size_t x = begin; x < end; ++x) {
      if (grid_.cell(row * size + x).empty()) continue;
      const std::span<const uint32_t> list = lists.list(x);
      const std::size_t blocks = (list.size() + block_size - 1) / block_size;
      if (scratch.cell.size() < blocks) scratch.cell.resize(blocks + blocks / 4);
      for (std::size_t i = 0; i < blocks * block_size; ++i) {
        Vec3f c[3];
        if (i < list.size())
          for (std::size_t k = 0; k < 3; ++k)
            c[k] = triangles_.working(geometry_->indices[3 * std::size_t{list[i]} + k]);
        put(scratch.cell[i / block_size], i % block_size, i < list.size() ? c : nullptr);
      }
      do_cell(row * size + x, list.size(), scratch);
    }
    begin = end;
  }
}

void Backend::do_cell(std::size_t cell, std::size_t triangles, Scratch& scratch) {
  const std::span<ViewPoint> points = grid_.cell(cell);
  if (points.empty()) return;
  const Occluders scene{&light_,
                        &output_,
                        &triangles_.boxes(),
                        triangles_.blocks().data(),
                        triangles_.first_leaf(),
                        triangles_.listed().data(),
                        triangles_.listed_count()};
  order_groups(points, scratch.points);
  each_group(points.size(), [&](std::size_t begin, std::size_t count) {
    if (clusters())
      walk_tree(scene, points.data() + begin, count, scratch);
    else
      walk_cell(scene, triangles, points.data() + begin, count, scratch);
  });
}

Counters Backend::counters() {
  Counters c;
  const auto per_view_sample = [&](uint64_t n) {
    return counts_.view_samples ? static_cast<double>(n) / static_cast<double>(counts_.view_samples) : 0.0;
  };
  std::size_t most = 0, cells = 0;
  for (std::size_t i = 0; i < grid_.cell_count(); ++i) most = std::max(most, grid_.cell(i).size()), ++cells;
  c["view_samples_per_cell_average"] =
      static_cast<double>(grid_.view_samples()) / static_cast<double>(std::max<std::size_t>(1, cells - 1));
  c["view_samples_per_cell_max"] = static_cast<double>(most);
  c["groups"] = static_cast<double>(counts_.groups);
  c["pairs_rasterised"] = static_cast<double>(counts_.pairs);
  c["vector_lanes"] = static_cast<double>(vector_lanes());
  c["structure_bytes"] = static_cast<double>(structure_bytes());
  if (clusters()) {
    const double groups = std::max(1.0, static_cast<double>(counts_.groups));
    c["nodes_per_group"] = static_cast<double>(counts_.nodes) / groups;
    c["blocks_per_group"] = static_cast<double>(counts_.blocks_found) / groups;
    c["blocks_entered_per_view_sample"] = per_view_sample(counts_.blocks_entered);
    c["tree_leaves"] = static_cast<double>(triangles_.leaf_count());
    c["tree_nodes"] = static_cast<double>(triangles_.node_count());
    c["triangles_outside_tree"] = static_cast<double>(triangles_.listed_count());
    return c;
  }
  uint64_t assignments = 0, longest = 0;
  for (const CellLists::Worker& l : lists_) assignments += l.assignments, longest = std::max(longest, l.most);
  c["assignments_to_cells"] = static_cast<double>(assignments);
  c["triangles_per_cell_average"] = static_cast<double>(assignments) / static_cast<double>(cells - 1);
  c["triangles_per_cell_max"] = static_cast<double>(longest);
  c["triangles_outside_grid"] = static_cast<double>(triangles_.listed_count());
  return c;
}

uint64_t Backend::structure_bytes() const {
  uint64_t b = triangles_.bytes() + grid_.bytes() + output_.bytes() +
               (light_.x.capacity() + light_.y.capacity() + light_.z.capacity()) * sizeof(float);
  for (const Scratch& s : scratch_) b += s.bytes();
  for (const CellLists::Worker& l : lists_) b += l.bytes();
  return b;
}

}  // namespace

std::unique_ptr<Technique> make_backend(const GearsParams& params) {
  return std::make_unique<Backend>(params);
}

}  // namespace penumbra::gears::cpu
