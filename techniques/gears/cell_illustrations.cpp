#include <cmath>
#include <limits>

#include "techniques/gears/cell_statistics.h"
#include "techniques/gears/cells.h"

namespace penumbra::gears {
namespace {

// Projected volumes that are drawn over the grid: more hide each other.
constexpr std::size_t most_volumes = 10;

std::vector<uint32_t> read(const gpu::Buffer& buffer, std::size_t count, gpu::PassRecorder& passes) {
  std::vector<uint32_t> words(count);
  if (count > 0) gpu::download(passes, "read_lists", buffer, words.data(), count * 4);
  return words;
}

}  // namespace

std::vector<Illustration> Cells::illustrations(FrameState& state, const RenderInput& in,
                                               gpu::PassRecorder& passes) const {
  const std::vector<uint32_t> samples = read(sample_counts_, cell_count(), passes),
                              triangles = read(triangle_counts_, cell_count(), passes),
                              slots = read(state.slots, std::size_t{group_count_} * state.lanes, passes),
                              cells = read(group_cells_, group_count_, passes);
  const Header header = state.read_header(passes);
  PixelFigures tested{std::vector<float>(state.pixels(), std::numeric_limits<float>::quiet_NaN())};
  for (std::size_t s = 0; s < slots.size(); ++s)
    if (slots[s] < tested.values.size())
      tested.values[slots[s]] = static_cast<float>(triangles[cells[s / state.lanes]] + list_count_);
  const auto side = static_cast<int>(grid_size_);
  const auto of_grid = [&](const std::vector<uint32_t>& counts) {
    return GridFigures{side, side, {counts.begin(), counts.end() - 1}, {}, {}, "", ""};
  };
  GridFigures projections = of_grid(samples);
  projections.outer_name = "bounding rectangle, which is assigned";
  projections.inner_name = "convex hull";
  for (ProjectedVolume& v :
       projected_volumes(in.scene_case->frame->geometry, state.constants, header, grid_size_, most_volumes)) {
    projections.outer.push_back(std::move(v.rectangle));
    projections.inner.push_back(std::move(v.hull));
  }
  return {{"triangles_per_view_sample", "Triangles assigned to the cell of each view sample", tested},
          {"view_samples_over_grid", "View samples in each cell of the grid", of_grid(samples)},
          {"triangles_over_grid", "Triangles in each cell of the grid", of_grid(triangles)},
          {"projected_volumes", "Shadow volumes of a few triangles, projected onto the grid of view samples",
           std::move(projections)}};
}

}  // namespace penumbra::gears
