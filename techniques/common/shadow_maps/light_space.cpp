#include "techniques/common/shadow_maps/light_space.h"

namespace penumbra::shadow_map {
namespace {

Mat4d from_rows(Vec4d r0, Vec4d r1, Vec4d r2, Vec4d r3) {
  Mat4d m;
  for (int c = 0; c < 4; ++c) m[c] = {r0[c], r1[c], r2[c], r3[c]};
  return m;
}

Vec4d row(Vec3d v, double w) { return {v.x, v.y, v.z, w}; }

Mat4d transposed(const Mat4d& m) { return from_rows(m[0], m[1], m[2], m[3]); }

Vec4f to_float4(Vec4d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(v.w)};
}

// Room on both sides: an extent without size (one sample, a plane seen edge-on) still gets a map.
void pad(double& lo, double& hi, double relative, double least) {
  const double size = std::max({hi - lo, 1e-6 * std::max(std::abs(lo), std::abs(hi)), least});
  const double middle = 0.5 * (lo + hi);
  lo = std::min(lo, middle - 0.5 * size) - relative * size;
  hi = std::max(hi, middle + 0.5 * size) + relative * size;
}

}  // namespace

Mat4d light_from_world(const LightPoint& light, const LightFrame& frame) {
  const auto& [r, d, f] = frame;
  if (light.at_infinity()) return from_rows(row(r, 0), row(d, 0), row(f, 0), {0, 0, 0, 1});
  const Vec3d p = light.towards.xyz();
  return from_rows(row(r, -dot(r, p)), row(d, -dot(d, p)), {0, 0, 0, -1}, row(f, -dot(f, p)));
}

Extent decode(const SampleBounds& b) {
  Extent e;
  e.whole = b.outside != 0;
  if (b.lo[0] == 0xffffffffU) return e;
  for (int c = 0; c < 3; ++c) e.lo[c] = from_ordered(b.lo[c]), e.hi[c] = from_ordered(~b.hi[c]);
  e.view_lo = from_ordered(b.lo[3]), e.view_hi = from_ordered(~b.hi[3]);
  return e;
}

std::optional<Extent> extent_of(const Box& box, const Mat4d& light_from_world, double limit) {
  Extent e;
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner{i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z};
    const Vec4d p = light_from_world * row(corner, 1);
    if (p.w <= 0 || std::abs(p.x) > limit * p.w || std::abs(p.y) > limit * p.w) return {};
    e.extend(p.xyz() / p.w);
  }
  return e;
}

double inner_share(double map_size, double border) { return std::max(1 - 2 * border / map_size, 0.5); }

Mat4d crop(const Extent& e, double map_size, double border, double least_depth) {
  Extent p = e;
  for (int c = 0; c < 2; ++c) pad(p.lo[c], p.hi[c], 0, 1e-9);
  pad(p.lo.z, p.hi.z, 1e-2, least_depth);
  const double inner = inner_share(map_size, border);
  Mat4d m;
  for (int c = 0; c < 2; ++c) {
    m[c][c] = 2 * inner / (p.hi[c] - p.lo[c]);
    m[3][c] = -0.5 * (p.lo[c] + p.hi[c]) * m[c][c];
  }
  m[2][2] = 1 / (p.hi.z - p.lo.z);
  m[3][2] = -p.lo.z * m[2][2];
  return m;
}

double rounded_up(double size) { return std::exp2(std::ceil(4 * std::log2(size)) / 4); }

Extent snapped(const Extent& e, double map_size, double border) {
  Extent s = e;
  for (int c = 0; c < 2; ++c) {
    pad(s.lo[c], s.hi[c], 0, 1e-9);
    const double inner = inner_share(map_size, border) * map_size;
    // One texel of room, so that moving the corner to a whole texel keeps all inside.
    const double size = rounded_up((s.hi[c] - s.lo[c]) * inner / (inner - 1));
    const double texel = size / inner;
    s.lo[c] = std::floor(s.lo[c] / texel) * texel;
    s.hi[c] = s.lo[c] + size;
  }
  return s;
}

Vec3d map_point(const FittedLayer& layer, Vec3d p) {
  const Vec4d c = layer.clip_from_world * row(p, 1);
  Vec3d m = c.xyz() / c.w;
  if (layer.log.scale != 0) m.y = layer.log.scale * std::log(-1 / m.y) + layer.log.offset;
  return m;
}

MapLayer make_layer(const FittedLayer& layer, const LightPoint& light, double map_size, Vec3d edge_u,
                    Vec3d edge_v) {
  const Mat4d world_from_clip = inverse(layer.clip_from_world);
  const LightFrame& frame = layer.frame;
  MapLayer out{};
  out.clip_from_world = to_float(layer.clip_from_world);
  out.plane_from_world = to_float(transposed(world_from_clip));
  // Distance along the axis of the point that (clip x, clip y, depth, 1) unprojects to.
  const double offset = light.at_infinity() ? 0 : -dot(frame.forward, light.towards.xyz());
  const Vec4d linear = row(frame.forward, offset);
  Vec4d numerator, denominator;
  for (int c = 0; c < 4; ++c) {
    for (int i = 0; i < 4; ++i) numerator[c] += linear[i] * world_from_clip[c][i];
    denominator[c] = world_from_clip[c].w;
  }
  // The unprojected point may come with any scale; a common one keeps both in float's range.
  double largest = 0;
  for (int c = 0; c < 4; ++c) largest = std::max({largest, std::abs(numerator[c]), std::abs(denominator[c])});
  for (int c = 0; c < 4; ++c) numerator[c] /= largest, denominator[c] /= largest;
  out.linear_numerator = to_float4(numerator);
  out.linear_denominator = to_float4(denominator);
  out.linear_from_world = to_float4(linear);
  out.range = to_float4({layer.view_lo, layer.view_hi, layer.linear_lo, layer.linear_hi});
  out.log_warp = to_float4({layer.log.scale, layer.log.offset, 0, 0});
  // The map's own scale, texels per tangent: an unwarped clip matrix is crop * frame.
  const auto texels = [&](Vec3d axis, int r) {
    Vec3d clip_row{layer.clip_from_world[0][r], layer.clip_from_world[1][r], layer.clip_from_world[2][r]};
    return 0.5 * map_size * dot(clip_row, axis);
  };
  const auto across = [&](Vec3d edge) { return edge - frame.forward * dot(edge, frame.forward); };
  out.light_texels = to_float4({texels(across(edge_u), 0), texels(across(edge_u), 1),
                                texels(across(edge_v), 0), texels(across(edge_v), 1)});
  return out;
}

std::vector<double> split_depths(Split split, double lambda, int count, double lo, double hi) {
  std::vector<double> ends;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    const double uniform = lo + (hi - lo) * t, logarithmic = lo * std::pow(hi / lo, t);
    ends.push_back(split == Split::uniform ? uniform
                   : split == Split::log   ? logarithmic
                                           : lambda * logarithmic + (1 - lambda) * uniform);
  }
  return ends;
}

}  // namespace penumbra::shadow_map
