// The light's view is cut into cells, and each triangle counted into every cell that it touches: no ray meets
// more triangles than its cell has. Cells with too many are cut again.
#include "techniques/stencil_shadow_volume/layers.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"

namespace penumbra::shadow_volume {
namespace {

constexpr int first_cells = 512, further_cells = 16, deepest = 4;
constexpr double pad = 0.05;  // of a cell: rasterisers round vertices
constexpr std::size_t most_entries = std::size_t{64} << 20;

// One picture of the scene from the light: (x, y) / w, in the square [-1, 1]^2 where w > 0.
struct LightPicture {
  Vec3d origin, x, y, w;
  bool parallel;
  Vec3d see(Vec3f point) const {
    const Vec3d p = Vec3d(point) - origin;
    return {dot(x, p), dot(y, p), parallel ? 1 : dot(w, p)};
  }
};

LightPicture looking(Vec3d origin, Vec3d forward, double reach, bool parallel) {
  const Vec3d any = std::abs(forward.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  const Vec3d right = normalize(cross(any, forward)), up = cross(forward, right);
  return {origin, right / reach, up / reach, forward, parallel};
}

std::vector<LightPicture> pictures(const Box& bounds, Vec4d light) {
  constexpr double wider = 1.001;
  const Vec3d center(bounds.center());
  const double radius = std::max(double{bounds.diagonal()} / 2, 1e-30);
  if (light.w == 0) return {looking(center, normalize(light.xyz()), wider * radius, true)};
  const Vec3d eye = light.xyz();
  const double away = length(center - eye);
  if (away > 1.05 * radius) {
    const double reach = wider * radius / std::sqrt(away * away - radius * radius);
    return {looking(eye, (center - eye) / away, reach, false)};
  }
  std::vector<LightPicture> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3d forward;
      forward[axis] = side;
      faces.push_back(looking(eye, forward, wider, false));
    }
  return faces;
}

// A triangle as a picture shows it: convex, in [-1, 1]^2.
struct Outline {
  Vec3d at[8];
  int count = 0;

  Outline(const LightPicture& picture, const Geometry& g, std::size_t triangle) {
    for (int i = 0; i < 3; ++i) at[count++] = picture.see(g.corner(triangle, i));
    for (const Vec3d side : {Vec3d{1, 0, 1}, Vec3d{-1, 0, 1}, Vec3d{0, 1, 1}, Vec3d{0, -1, 1}}) clip(side);
    for (int i = 0; i < count; ++i)
      if (at[i].z <= 0) everywhere();  // the light lies in the triangle
    for (int i = 0; i < count; ++i) at[i] = at[i] / at[i].z;
  }

 private:
  void clip(Vec3d side) {
    Vec3d out[8];
    int n = 0;
    for (int i = 0; i < count; ++i) {
      const Vec3d a = at[i], b = at[(i + 1) % count];
      const double ha = dot(side, a), hb = dot(side, b);
      if (ha >= 0) out[n++] = a;
      if ((ha < 0) != (hb < 0)) out[n++] = a + (b - a) * (ha / (ha - hb));
    }
    std::copy(out, out + n, at), count = n;
  }
  void everywhere() {
    count = 4;
    at[0] = {-1, -1, 1}, at[1] = {1, -1, 1}, at[2] = {1, 1, 1}, at[3] = {-1, 1, 1};
  }
};

// A square of the picture, cut into cells x cells.
struct Grid {
  double x, y, cell;
  int cells;

  Grid part(int column, int row) const {
    return {x + column * cell, y + row * cell, cell / further_cells, further_cells};
  }
  // Calls f(row, first column, last column) for the cells that the outline comes near to.
  template <class F>
  void rows(const Outline& outline, F f) const {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < outline.count; ++i) {
      low = std::min(low, (outline.at[i].y - y) / cell), high = std::max(high, (outline.at[i].y - y) / cell);
    }
    if (!(high + pad >= 0 && low - pad < cells)) return;
    const int first = index(low - pad), last = index(high + pad);
    for (int row = first; row <= last; ++row) {
      const auto [left, right] = extent(outline, row - pad, row + 1 + pad);
      if (right + pad >= 0 && left - pad < cells) f(row, index(left - pad), index(right + pad));
    }
  }

 private:
  int index(double v) const { return static_cast<int>(std::clamp(std::floor(v), 0.0, cells - 1.0)); }
  // In x of what lies between two heights, in cells.
  std::pair<double, double> extent(const Outline& outline, double bottom, double top) const {
    double left = INFINITY, right = -INFINITY;
    const auto add = [&](double v) { left = std::min(left, v), right = std::max(right, v); };
    for (int i = 0; i < outline.count; ++i) {
      const Vec3d &p = outline.at[i], &q = outline.at[(i + 1) % outline.count];
      const double px = (p.x - x) / cell, py = (p.y - y) / cell, qx = (q.x - x) / cell, qy = (q.y - y) / cell;
      if (py >= bottom && py <= top) add(px);
      for (const double h : {bottom, top})
        if ((py < h) != (qy < h)) add(px + (qx - px) * ((h - py) / (qy - py)));
    }
    return {left, right};
  }
};

class Search {
 public:
  Search(const Geometry& g, const LightPicture& picture, uint32_t enough)
      : g_(g), picture_(picture), enough_(enough) {}

  uint32_t run() {
    const std::vector<uint32_t> counts = count_all();
    std::vector<uint32_t> crowded;  // 1 + number of the cell, where it has too many
    std::vector<std::pair<int, int>> cells;
    std::size_t entries = 0;
    uint32_t most = 0;
    crowded.resize(counts.size(), 0);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] <= enough_) {
        most = std::max(most, counts[i]);
        continue;
      }
      cells.emplace_back(static_cast<int>(i % first_cells), static_cast<int>(i / first_cells));
      crowded[i] = static_cast<uint32_t>(cells.size());
      entries += counts[i];
    }
    if (entries > most_entries) return *std::max_element(counts.begin(), counts.end());
    std::vector<std::vector<uint32_t>> lists(cells.size());
    if (!cells.empty()) collect(crowded, lists);
    std::atomic<uint32_t> bound{most};
    parallel_for(cells.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && bound <= enough_; ++i)
        raise(bound, refine(grid_.part(cells[i].first, cells[i].second), lists[i], 1));
    });
    return bound;
  }

 private:
  static void raise(std::atomic<uint32_t>& most, uint32_t value) {
    uint32_t before = most;
    while (before < value && !most.compare_exchange_weak(before, value)) {
    }
  }

  // Of each cell, by the differences between neighbours in a row.
  std::vector<uint32_t> count_all() const {
    constexpr std::size_t width = first_cells + 1;
    std::vector<int32_t> steps(width * first_cells, 0);
    parallel_for(g_.triangle_count(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        grid_.rows(Outline(picture_, g_, t), [&](int row, int first, int last) {
          int32_t* at = &steps[static_cast<std::size_t>(row) * width];
          std::atomic_ref(at[first]).fetch_add(1, std::memory_order_relaxed);
          std::atomic_ref(at[last + 1]).fetch_sub(1, std::memory_order_relaxed);
        });
    });
    std::vector<uint32_t> counts;
    counts.reserve(std::size_t{first_cells} * first_cells);
    for (std::size_t row = 0; row < first_cells; ++row) {
      int32_t sum = 0;
      for (std::size_t column = 0; column < first_cells; ++column)
        counts.push_back(static_cast<uint32_t>(sum += steps[row * width + column]));
    }
    return counts;
  }

  void collect(const std::vector<uint32_t>& crowded, std::vector<std::vector<uint32_t>>& lists) const {
    for (std::size_t t = 0; t < g_.triangle_count(); ++t)
      grid_.rows(Outline(picture_, g_, t), [&](int row, int first, int last) {
        for (int column = first; column <= last; ++column) {
          const uint32_t cell = crowded[static_cast<std::size_t>(row * first_cells + column)];
          if (cell) lists[cell - 1].push_back(static_cast<uint32_t>(t));
        }
      });
  }

  uint32_t refine(const Grid& grid, const std::vector<uint32_t>& triangles, int depth) const {
    std::vector<std::vector<uint32_t>> lists(further_cells * further_cells);
    for (uint32_t t : triangles)
      grid.rows(Outline(picture_, g_, t), [&](int row, int first, int last) {
        for (int column = first; column <= last; ++column)
          lists[static_cast<std::size_t>(row * further_cells + column)].push_back(t);
      });
    uint32_t most = 0;
    for (std::size_t i = 0; i < lists.size() && most <= enough_; ++i) {
      const auto size = static_cast<uint32_t>(lists[i].size());
      if (size > enough_ && depth < deepest)
        most = std::max(
            most, refine(grid.part(static_cast<int>(i) % further_cells, static_cast<int>(i) / further_cells),
                         lists[i], depth + 1));
      else
        most = std::max(most, size);
    }
    return most;
  }

  const Geometry& g_;
  const LightPicture& picture_;
  uint32_t enough_;
  Grid grid_{-1, -1, 2.0 / first_cells, first_cells};
};

}  // namespace

uint32_t most_layers(const Geometry& geometry, Vec4d light, uint32_t enough) {
  if (geometry.triangle_count() <= enough) return static_cast<uint32_t>(geometry.triangle_count());
  uint32_t most = 0;
  for (const LightPicture& picture : pictures(geometry.bounds, light))
    if (most <= enough) most = std::max(most, Search(geometry, picture, enough).run());
  return most;
}

}  // namespace penumbra::shadow_volume
