#include "techniques/line_space/casters.h"

namespace penumbra::line_space {
namespace {

// Scene diagonals: a sixth of the offset from P to P'. What stands on a ground plane reaches below it by
// rounding.
constexpr float nearness = 1e-6F;

float& axis_of(Vec3f& v, uint32_t axis) { return v[static_cast<int>(axis)]; }
float axis_of(const Vec3f& v, uint32_t axis) { return v[static_cast<int>(axis)]; }

float largest(Vec3f v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

uint32_t faces_before_light(const Box& scene, const LightSamples& light) {
  uint32_t faces = 0;
  for (uint32_t f = 0; f < 6; ++f) {
    const uint32_t axis = f / 2;
    bool inner = true;
    for (const Vec4f& l : light.points) {
      const float plane = l.w * (f % 2 ? axis_of(scene.hi, axis) : axis_of(scene.lo, axis));
      const float at = l[static_cast<int>(axis)];
      inner = inner && (f % 2 ? at < plane : at > plane);
    }
    faces |= inner ? 1U << f : 0U;
  }
  return faces;
}

std::vector<uint32_t> select_casters(const Geometry& geometry, uint32_t faces) {
  const float near = nearness * geometry.bounds.diagonal();
  std::vector<uint32_t> casters;
  casters.reserve(geometry.triangle_count());
  for (std::size_t t = 0; t < geometry.triangle_count(); ++t) {
    bool in_face = false;
    for (uint32_t f = 0; f < 6 && !in_face; ++f) {
      if ((faces >> f & 1) == 0) continue;
      const float plane = f % 2 ? axis_of(geometry.bounds.hi, f / 2) : axis_of(geometry.bounds.lo, f / 2);
      in_face = true;
      for (int k = 0; k < 3; ++k)
        in_face = in_face && std::abs(axis_of(geometry.corner(t, k), f / 2) - plane) <= near;
    }
    if (!in_face) casters.push_back(static_cast<uint32_t>(t));
  }
  return casters;
}

uint32_t Grid::fine_cells() const {
  uint32_t cells = 1;
  for (uint32_t l = 1; l < depth; ++l) cells *= branching;
  return cells;
}

uint32_t Grid::leaves() const { return fine_cells() * branching; }

Vec3f Grid::scale(uint32_t cells) const {
  const auto n = static_cast<float>(cells);
  return {n / size.x, n / size.y, n / size.z};
}

// The second term is for the rounding of the overlap test itself, whose numbers are up to leaves().
Vec3f Grid::padding() const {
  const float rounding = static_cast<float>(leaves()) * 0x1p-20F;
  return leaf_scale() * slack + Vec3f{rounding, rounding, rounding};
}

Grid make_grid(const Geometry& geometry, const std::vector<uint32_t>& casters, const Params& params) {
  Grid grid;
  grid.branching = static_cast<uint32_t>(params.branching), grid.depth = static_cast<uint32_t>(params.depth);
  // A shadow segment's points in the tree are computed from numbers up to `reach`, in fewer than 32 roundings
  // of 2^-24 each (shaders/traverse.glsl).
  const float reach =
      geometry.bounds.diagonal() + std::max(largest(geometry.bounds.lo), largest(geometry.bounds.hi));
  grid.slack = reach * 0x1p-19F;
  Box box;
  for (const uint32_t t : casters)
    for (int k = 0; k < 3; ++k) box.extend(geometry.corner(t, k));
  if (box.empty()) box = geometry.bounds;
  // Wider than the offset of P' from P, so that what starts on a triangle starts in the tree; and no leaf
  // thinner than four times the slack, however flat the box.
  const float margin = 1e-5F * reach, thinnest = 4 * grid.slack * static_cast<float>(grid.leaves());
  for (uint32_t a = 0; a < 3; ++a) {
    const float lo = axis_of(box.lo, a) - margin, hi = axis_of(box.hi, a) + margin;
    axis_of(grid.size, a) = std::max(hi - lo, thinnest);
    axis_of(grid.lo, a) = (lo + hi - axis_of(grid.size, a)) * 0.5F;
  }
  if (params.cells == Params::Cells::cubic) {
    const float side = largest(grid.size);
    grid.lo = grid.lo + (grid.size - Vec3f{side, side, side}) * 0.5F;
    grid.size = {side, side, side};
  }
  return grid;
}

}  // namespace penumbra::line_space
