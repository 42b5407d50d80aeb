// The filters of FLIP [Andersson 2020, sec. 4.1.1 and 4.2.1], all of them sums of separable ones.
#pragma once
#include <vector>

namespace penumbra::flip_filters {

// Weights at -radius ... radius.
struct Kernel {
  std::vector<float> weights;
  int radius() const { return static_cast<int>(weights.size() / 2); }
};

struct Filters {
  // Contrast sensitivity. Blue-yellow has two Gaussians; their shares are in the vertical ones.
  Kernel y, cx, cz_horizontal[2], cz_vertical[2];
  // Detectors of edges and points in one direction: derivatives of a Gaussian, and that itself across.
  Kernel smooth, edge, point;
  // The largest of all.
  int radius = 0;
};

Filters make_filters(double pixels_per_degree);

}  // namespace penumbra::flip_filters
