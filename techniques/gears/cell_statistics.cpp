#include "techniques/gears/cell_statistics.h"

#include <algorithm>
#include <bit>

#include "technique/illustration.h"

namespace penumbra::gears {
namespace {

constexpr std::size_t most_triangles = 20000;

struct Areas {
  double box = 0, hull = 0;
};

double cross(Vec2d o, Vec2d a, Vec2d b) { return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x); }

// Andrew's monotone chain; the points are sorted.
std::vector<Vec2d> convex_hull(std::vector<Vec2d>& points) {
  std::ranges::sort(points, [](Vec2d a, Vec2d b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Vec2d> hull(2 * points.size());
  std::size_t size = 0;
  const auto add = [&](Vec2d p, std::size_t from) {
    while (size >= from + 2 && cross(hull[size - 2], hull[size - 1], p) <= 0) --size;
    hull[size++] = p;
  };
  for (const Vec2d& p : points) add(p, 0);
  const std::size_t lower = size - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.resize(size - 1);  // the last is the first
  return hull;
}

double area(const std::vector<Vec2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::abs(twice) / 2;
}

struct Rectangle {
  Vec2d lo, hi;
};
Rectangle bounding_rectangle(const std::vector<Vec2d>& points) {
  Rectangle r{points.front(), points.front()};
  for (const Vec2d& p : points) {
    r.lo = {std::min(r.lo.x, p.x), std::min(r.lo.y, p.y)};
    r.hi = {std::max(r.hi.x, p.x), std::max(r.hi.y, p.y)};
  }
  return r;
}

class Projector {
 public:
  Projector(const FrameConstants& f, const Header& h)
      : f_(f), farthest_(static_cast<double>(std::bit_cast<float>(h.farthest))) {
    for (uint32_t c = 0; c < f.light.corner_count; ++c)
      corners_.push_back(camera(Vec3d(f.light.corners[c].xyz())));
  }

  // False when the shadow volume reaches the camera's plane.
  bool project(const Geometry& geometry, std::size_t triangle) {
    points_.clear();
    for (int k = 0; k < 3; ++k)
      if (!add_corner(camera(Vec3d(geometry.corner(triangle, k))))) return false;
    return true;
  }
  // On the image plane: the vertices of the volume that was projected last.
  std::vector<Vec2d>& points() { return points_; }

 private:
  static Vec3d apply(const Vec4f& x, const Vec4f& y, const Vec4f& z, Vec3d d) {
    return {dot(Vec3d(x.xyz()), d), dot(Vec3d(y.xyz()), d), dot(Vec3d(z.xyz()), d)};
  }
  Vec3d camera(Vec3d world) const {
    const LightBasis& b = f_.light;
    const Vec3d working = apply(b.row_x, b.row_y, b.row_z, world - Vec3d(b.origin.xyz()));
    return apply(f_.camera_x, f_.camera_y, f_.camera_z, working - Vec3d(f_.camera_eye.xyz()));
  }
  bool add(Vec3d p) {
    if (f_.camera_eye.w == 0) return points_.push_back({p.x, p.y}), true;
    if (!(p.z > static_cast<double>(f_.near))) return false;
    points_.push_back({p.x / p.z, p.y / p.z});
    return true;
  }
  bool add_corner(Vec3d b) {
    if (!add(b)) return false;
    if (f_.camera_eye.w == 0) return true;
    for (const Vec3d& l : corners_) {
      const Vec3d d = b - l;
      if (f_.paper_extrusion != 0) {
        if (!add(b + d)) return false;
      } else if (b.z < farthest_) {
        if (!(d.z > static_cast<double>(f_.near)) || !add(l + d * ((farthest_ - l.z) / d.z))) return false;
      }
    }
    return true;
  }

  const FrameConstants& f_;
  double farthest_;
  std::vector<Vec3d> corners_;
  std::vector<Vec2d> points_;
};

}  // namespace

void add_cell_counters(const CellCounts& counts, Counters& counters) {
  const std::size_t cells = counts.samples.size() - 1;
  double samples = 0, triangles = 0, most_samples = 0, most_of_a_cell = 0, pairs = 0;
  std::vector<double> heat(cells);
  for (std::size_t c = 0; c <= cells; ++c) {
    const double s = counts.samples[c], t = counts.triangles[c];
    pairs += s * t;
    if (c == cells) continue;
    heat[c] = s;
    samples += s;
    triangles += t;
    most_samples = std::max(most_samples, s);
    most_of_a_cell = std::max(most_of_a_cell, t);
  }
  counters["view_samples_per_cell_average"] = samples / static_cast<double>(cells);
  counters["view_samples_per_cell_max"] = most_samples;
  counters["triangles_per_cell_average"] = triangles / static_cast<double>(cells);
  counters["triangles_per_cell_max"] = most_of_a_cell;
  counters["view_samples_off_grid"] = static_cast<double>(counts.samples[cells]);
  counters["total_assignments"] = pairs;
  counters["view_samples_of_cells"] = heat;
}

void add_area_counters(const Geometry& geometry, const FrameConstants& constants, const Header& header,
                       Counters& counters) {
  Projector projector(constants, header);
  const std::size_t count = geometry.triangle_count(),
                    step = std::max<std::size_t>(1, count / most_triangles);
  Areas areas;
  double left_out = 0;
  for (std::size_t t = 0; t < count; t += step) {
    if (!projector.project(geometry, t)) {
      ++left_out;
      continue;
    }
    const Rectangle r = bounding_rectangle(projector.points());
    areas.box += (r.hi.x - r.lo.x) * (r.hi.y - r.lo.y);
    areas.hull += area(convex_hull(projector.points()));
  }
  counters["area_bounding_rectangles"] = areas.box;
  counters["area_convex_hulls"] = areas.hull;
  counters["area_ratio"] = areas.hull > 0 ? areas.box / areas.hull : 0;
  counters["area_triangles_left_out"] = left_out;
}

std::vector<ProjectedVolume> projected_volumes(const Geometry& geometry, const FrameConstants& constants,
                                               const Header& header, uint32_t grid_size, std::size_t most) {
  Projector projector(constants, header);
  const double side = grid_size;
  const auto in_cells = [&](Vec2d p) {
    return Vec2d{(p.x - double(header.grid_lo[0])) * double(header.grid_scale[0]),
                 (p.y - double(header.grid_lo[1])) * double(header.grid_scale[1])};
  };
  std::vector<ProjectedVolume> volumes;
  // More than are wanted are looked at: many touch no cell.
  for (std::size_t t = 0, step = every_nth(geometry.triangle_count(), 16 * most);
       t < geometry.triangle_count(); t += step) {
    if (!projector.project(geometry, t)) continue;
    for (Vec2d& p : projector.points()) p = in_cells(p);
    const Rectangle r = bounding_rectangle(projector.points());
    if (r.lo.x >= side || r.lo.y >= side || r.hi.x <= 0 || r.hi.y <= 0) continue;
    volumes.push_back({{r.lo, {r.hi.x, r.lo.y}, r.hi, {r.lo.x, r.hi.y}}, convex_hull(projector.points())});
  }
  std::vector<ProjectedVolume> picked;
  for (std::size_t i = 0, step = every_nth(volumes.size(), most); i < volumes.size(); i += step)
    picked.push_back(std::move(volumes[i]));
  return picked;
}

}  // namespace penumbra::gears
