#include "techniques/gears/cpu_grid.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace penumbra::gears::cpu {
namespace {

constexpr std::size_t bins = 1024;

Vec3f to_working(const LightBasis& b, Vec3f world) {
  const Vec3f d = world - b.origin.xyz();
  return {dot(b.row_x.xyz(), d), dot(b.row_y.xyz(), d), dot(b.row_z.xyz(), d)};
}

Vec3f to_camera(const FrameConstants& f, Vec3f working) {
  const Vec3f d = working - f.camera_eye.xyz();
  return {dot(f.camera_x.xyz(), d), dot(f.camera_y.xyz(), d), dot(f.camera_z.xyz(), d)};
}
bool perspective(const FrameConstants& f) { return f.camera_eye.w != 0; }

// On C's image plane; z: the distance before it.
Vec3f project(const FrameConstants& f, Vec3f working) {
  const Vec3f c = to_camera(f, working);
  return perspective(f) ? Vec3f{c.x / c.z, c.y / c.z, c.z} : c;
}

// False where no point of the light can be above the horizon of P' = o with normal n, or o is behind the
// light.
bool reachable(const LightBasis& b, Vec4f o, Vec3f n, float slack) {
  if (o.w == 0) return false;
  float highest = -1e30F;
  for (uint32_t c = 0; c < b.corner_count; ++c)
    highest = std::max(highest, dot(n, b.corners[c].xyz() - o.xyz() * b.corners[c].w));
  const bool front =
      b.front_only == 0 || dot(b.row_z.xyz(), o.xyz() - b.origin.xyz()) > -slack * length(b.row_z.xyz());
  return highest > -slack && front;
}

// The place on the image plane of a histogram's bin, over the whole plane.
float plane_of(float bin, float unit) {
  const float t = std::clamp(bin / static_cast<float>(bins) * 2 - 1, -0.9999F, 0.9999F);
  return t / (1 - std::abs(t)) * unit;
}

std::size_t row_chunk(const ViewSamplesHost& view) {
  return std::max<std::size_t>(1, 8192 / static_cast<std::size_t>(std::max(1, view.width)));
}

}  // namespace

// From the 3rd to the 97th percentile and 15 % more at each side, at most what there is: a few far view
// samples would otherwise leave all others in one cell.
void Grid::fit(const FrameConstants& f, const ViewSamplesHost& view, float slack) {
  uint32_t histogram[2][bins] = {};
  const int step = std::max(1, std::max(view.width, view.height) / 256);
  uint32_t all = 0;
  for (int y = 0; y < view.height; y += step)
    for (int x = 0; x < view.width; x += step) {
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x);
      if (!reachable(f.light, view.origin[pixel], view.geometric_normal[pixel].xyz(), slack)) continue;
      const Vec3f q = project(f, to_working(f.light, view.origin[pixel].xyz()));
      if (perspective(f) && !(q.z > f.near)) continue;
      ++all;
      for (int k = 0; k < 2; ++k) {
        const float v = q[k] / f.grid_unit, t = v / (1 + std::abs(v));
        const float bin =
            std::clamp((t * 0.5F + 0.5F) * static_cast<float>(bins), 0.0F, static_cast<float>(bins - 1));
        ++histogram[k][static_cast<std::size_t>(bin)];
      }
    }
  for (std::size_t k = 0; k < 2; ++k) {
    const uint32_t low = all * 3 / 100, high = all - low;
    uint32_t before = 0;
    std::size_t first = bins, q0 = bins, q1 = 0, last = 0;
    for (std::size_t b = 0; b < bins; ++b) {
      const uint32_t n = histogram[k][b];
      if (n > 0 && first == bins) first = b;
      if (n > 0) last = b;
      if (before + n > low && q0 == bins) q0 = b;
      if (n > 0 && before < high) q1 = b;
      before += n;
    }
    const auto at = [&](std::size_t b) { return plane_of(static_cast<float>(b), f.grid_unit); };
    const float a = at(q0), b = at(q1 + 1), more = (b - a) * 0.15F;
    const float lo = std::max(at(first), a - more), hi = std::min(at(last + 1), b + more);
    lo_[k] = all == 0 ? 0 : lo;
    scale_[k] = all == 0 ? 1 : static_cast<float>(size_) / std::max(hi - lo, 1e-30F);
  }
}

// Places chunk by chunk, then counts, then a copy in the order of the cells: none of it depends on the
// threads.
void Grid::assign(const FrameConstants& f, const ViewSamplesHost& view, float slack, int size,
                  const MaskOutput& out) {
  size_ = size;
  fit(f, view, slack);
  for (uint32_t c = 0; c < f.light.corner_count; ++c)
    light_corners_[c] = to_camera(f, to_working(f.light, f.light.corners[c].xyz()));
  const auto width = static_cast<std::size_t>(view.width), height = static_cast<std::size_t>(view.height);
  const std::size_t rows = row_chunk(view), chunks = (height + rows - 1) / rows,
                    cells = static_cast<std::size_t>(size) * static_cast<std::size_t>(size) + 1;
  places_.resize(width * height), chunk_used_.resize(chunks), chunk_farthest_.assign(chunks, 0.0F);
  struct Call {
    Grid& self;
    const FrameConstants& f;
    const ViewSamplesHost& view;
    const MaskOutput& out;
    float slack;
    std::size_t width, height, rows;
  } const call{*this, f, view, out, slack, width, height, rows};
  parallel_for(chunks, 1, [&call](std::size_t chunk, std::size_t) {
    const std::size_t begin = chunk * call.rows * call.width,
                      end = std::min(call.height, (chunk + 1) * call.rows) * call.width;
    std::size_t used = begin;
    float far = 0;
    const auto last = static_cast<float>(call.self.size_ - 1);
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      const Vec4f o = call.view.origin[pixel];
      if (!reachable(call.f.light, o, call.view.geometric_normal[pixel].xyz(), call.slack)) {
        call.out.write_blocked(static_cast<uint32_t>(pixel));
        continue;
      }
      Vec3f p = to_working(call.f.light, o.xyz());
      const Vec3f q = project(call.f, p);
      far = std::max(far, q.z);
      uint32_t cell = static_cast<uint32_t>(call.self.size_) * static_cast<uint32_t>(call.self.size_);
      if (!perspective(call.f) || q.z > call.f.near) {
        const auto along = [&](int k) {
          return static_cast<uint32_t>(
              std::clamp((q[k] - call.self.lo_[k]) * call.self.scale_[k], 0.0F, last));
        };
        cell = along(1) * static_cast<uint32_t>(call.self.size_) + along(0);
      }
      // Before the light, however near to its plane.
      if (call.f.light.front_only != 0) p.z = std::max(p.z, call.f.pad);
      call.self.places_[used++] = {{p.x, p.y, p.z, static_cast<uint32_t>(pixel)}, cell};
    }
    call.self.chunk_used_[chunk] = static_cast<uint32_t>(used - begin);
    call.self.chunk_farthest_[chunk] = far;
  });
  farthest_ = *std::max_element(chunk_farthest_.begin(), chunk_farthest_.end());
  start_.assign(cells + 1, 0);
  const auto each = [&](const auto& body) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk)
      for (std::size_t i = 0; i < chunk_used_[chunk]; ++i) body(places_[chunk * rows * width + i]);
  };
  each([&](const Place& p) { ++start_[p.cell + 1]; });
  for (std::size_t c = 0; c < cells; ++c) start_[c + 1] += start_[c];
  points_.reserve(width * height);
  points_.resize(start_.back());
  each([&](const Place& p) { points_[start_[p.cell]++] = p.point; });
  for (std::size_t c = cells; c > 0; --c) start_[c] = start_[c - 1];
  start_[0] = 0;
}

bool Grid::axis(std::size_t k, float lo, float hi, uint16_t* first, uint16_t* last) const {
  const float slack = 1e-3F + 4e-6F * std::max({std::abs(lo), std::abs(hi), std::abs(lo_[k])}) * scale_[k];
  const auto end = static_cast<float>(size_ - 1);
  const float from = std::clamp((lo - lo_[k]) * scale_[k] - slack, 0.0F, end),
              to = std::clamp((hi - lo_[k]) * scale_[k] + slack, 0.0F, end);
  if (!(from <= to)) return false;  // not a number
  *first = static_cast<uint16_t>(from), *last = static_cast<uint16_t>(to);
  return true;
}

bool Grid::cells_of(const FrameConstants& f, const Vec3f* corners, CellRange& out) const {
  float lo[2] = {1e30F, 1e30F}, hi[2] = {-1e30F, -1e30F};
  const auto add = [&](float x, float y, float error) {
    lo[0] = std::min(lo[0], x - error), hi[0] = std::max(hi[0], x + error);
    lo[1] = std::min(lo[1], y - error), hi[1] = std::max(hi[1], y + error);
  };
  for (int k = 0; k < 3; ++k) {
    const Vec3f b = to_camera(f, corners[k]);
    if (!perspective(f)) {
      add(b.x, b.y, f.pad);  // the shadow runs along the camera's axis
      continue;
    }
    if (!(b.z > f.near)) return false;
    add(b.x / b.z, b.y / b.z, 2 * f.pad / b.z);
    for (uint32_t c = 0; c < f.light.corner_count; ++c) {
      const Vec3f l = light_corners_[c], d = b - l;
      if (f.paper_extrusion != 0) {
        const Vec3f e = b + d;
        if (!(e.z > f.near)) return false;
        add(e.x / e.z, e.y / e.z, 4 * f.pad / e.z);
      } else if (b.z < farthest_) {
        if (!(d.z > f.near)) return false;
        const float s = (farthest_ - l.z) / d.z;
        add((l.x + d.x * s) / farthest_, (l.y + d.y * s) / farthest_, 2 * f.pad / d.z);
      }
    }
  }
  return axis(0, lo[0], hi[0], &out.x0, &out.x1) && axis(1, lo[1], hi[1], &out.y0, &out.y1);
}

uint64_t Grid::bytes() const {
  return (start_.capacity() + chunk_used_.capacity()) * sizeof(uint32_t) +
         places_.capacity() * sizeof(Place) + points_.capacity() * sizeof(ViewPoint) +
         chunk_farthest_.capacity() * sizeof(float);
}

}  // namespace penumbra::gears::cpu
