// backend: cpu. The grid that the camera C carries: which cell a view sample falls into, which ones a
// triangle's shadow volume touches. The same definitions as shaders/grid_camera.glsl, fit_grid.comp,
// bin_samples.comp and bin_triangles.comp.
#pragma once
#include <span>
#include <vector>

#include "samples/view_samples.h"
#include "techniques/gears/cpu_kernel.h"
#include "techniques/gears/cpu_output.h"
#include "techniques/gears/shaders/shared.h"

namespace penumbra::gears::cpu {

struct CellRange {
  uint16_t x0, y0, x1, y1;  // inclusive
};

class Grid {
 public:
  // Fits the grid to the view samples that the light can reach, and puts them into its cells. Writes the
  // other pixels' outputs.
  void assign(const FrameConstants& f, const ViewSamplesHost& view, float slack, int size,
              const MaskOutput& out);
  // The view samples of cell y * size + x; the last cell, size * size, has those without a place.
  std::span<ViewPoint> cell(std::size_t i) { return {points_.data() + start_[i], start_[i + 1] - start_[i]}; }
  std::size_t cell_count() const { return start_.size() - 1; }
  std::size_t view_samples() const { return points_.size(); }

  // Of a triangle in working space. False: its volume has no place on the grid, and may touch every cell.
  bool cells_of(const FrameConstants& f, const Vec3f* corners, CellRange& out) const;
  uint64_t bytes() const;

 private:
  struct Place {
    ViewPoint point;
    uint32_t cell;
  };
  void fit(const FrameConstants& f, const ViewSamplesHost& view, float slack);
  bool axis(std::size_t k, float lo, float hi, uint16_t* first, uint16_t* last) const;

  int size_ = 1;
  float lo_[2] = {0, 0}, scale_[2] = {1, 1}, farthest_ = 0;
  Vec3f light_corners_[8];  // before the camera
  std::vector<uint32_t> start_;
  std::vector<Place> places_;  // chunk by chunk of the picture
  std::vector<uint32_t> chunk_used_;
  std::vector<float> chunk_farthest_;
  std::vector<ViewPoint> points_;
};

}  // namespace penumbra::gears::cpu
