#include "samples/light_samples.h"

#include <cmath>
#include <numbers>

#include "core/radical_inverse.h"
#include "samples/shaders/light_rotation.h"

namespace penumbra {
namespace {

uint32_t pcg(uint32_t v) { return light_rotation::rotation_hash(v); }

double unit(uint32_t bits) { return double(bits) * 0x1p-32; }

// A random number in [0, 1) for sample i, dimension d.
double random(uint32_t seed, uint32_t i, uint32_t d) { return unit(pcg(pcg(pcg(seed) + i) + d)); }

uint32_t reverse_bits(uint32_t v) {
  v = (v >> 1 & 0x55555555U) | (v & 0x55555555U) << 1;
  v = (v >> 2 & 0x33333333U) | (v & 0x33333333U) << 2;
  v = (v >> 4 & 0x0f0f0f0fU) | (v & 0x0f0f0f0fU) << 4;
  v = (v >> 8 & 0x00ff00ffU) | (v & 0x00ff00ffU) << 8;
  return v >> 16 | v << 16;
}

// Nested uniform scrambling by hashing from the highest bit down [Burley 2020, after Laine and Karras 2011].
uint32_t scramble(uint32_t x, uint32_t seed) {
  x = reverse_bits(x);
  x += seed;
  x ^= x * 0x6c50b47cU;
  x ^= x * 0xb82f1e52U;
  x ^= x * 0xc7afe638U;
  x ^= x * 0x8d22f6e6U;
  return reverse_bits(x);
}

// Second dimension of the Sobol sequence; the first is the bit reversal of the index.
uint32_t sobol_1(uint32_t i) {
  uint32_t value = 0;
  for (uint32_t v = 1U << 31; i; i >>= 1, v ^= v >> 1)
    if (i & 1U) value ^= v;
  return value;
}

struct UnitPoint {
  double s, t, r;  // r: third coordinate, used by volumes only
};

// Golden-ratio rank-1 lattice: what stands for "regular" where n need not be a rectangle's w x h.
UnitPoint lattice(uint32_t i, uint32_t n) {
  const double t = (i + 0.5) * (std::numbers::phi - 1);
  return {(i + 0.5) / n, t - std::floor(t), radical_inverse(i, 2)};
}

UnitPoint halton(uint32_t i, uint32_t seed) {
  const auto shifted = [&](uint32_t base, uint32_t d) {
    const double x = radical_inverse(i + 1, base) + random(seed, 0, d);
    return x - std::floor(x);
  };
  return {shifted(2, 0), shifted(3, 1), shifted(5, 2)};
}

// Point of the light at unit coordinates. Sphere: uniform over its volume.
Vec4f place(const Light& light, UnitPoint u) {
  Vec3f p;
  if (light.kind == LightKind::sphere) {
    const double z = 1 - 2 * u.t, rho = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * std::numbers::pi * u.s;
    const double radius = double(light.radius) * std::cbrt(u.r);
    p = light.center + Vec3f(Vec3d{rho * std::cos(phi), z, rho * std::sin(phi)} * radius);
  } else {
    p = light.at(static_cast<float>(u.s), static_cast<float>(u.t));
  }
  return {p.x, p.y, p.z, 1};
}

float texture_weight(const Light& light, UnitPoint u) {
  const int x = std::clamp(static_cast<int>(u.s * light.texture_width), 0, light.texture_width - 1);
  const int y = std::clamp(static_cast<int>(u.t * light.texture_height), 0, light.texture_height - 1);
  return light.weights[static_cast<std::size_t>(y * light.texture_width + x)];
}

void normalise_weights(LightSamples& out) {
  double sum = 0;
  for (float w : out.weights) sum += double(w);
  out.uniform_weights = true;
  for (float& w : out.weights) {
    w = sum > 0 ? static_cast<float>(double(w) / sum) : 1.0f / static_cast<float>(out.weights.size());
    out.uniform_weights = out.uniform_weights && w == out.weights.front();
  }
}

// Lights that one sample describes; false for the others.
bool single(const Light& light, LightSamples& out) {
  if (light.kind == LightKind::volume || (light.is_area() && light.size() > 0)) return false;
  if (light.kind == LightKind::directional)
    out.points = {{-light.direction.x, -light.direction.y, -light.direction.z, 0}};
  else
    out.points = {{light.center.x, light.center.y, light.center.z, 1}};
  out.weights = {1};
  out.width = out.height = 1;
  return true;
}

bool point_set(const Light& light, LightSamples& out) {
  if (light.kind != LightKind::volume) return false;
  for (Vec3f p : light.points) out.points.push_back({p.x, p.y, p.z, 1});
  out.weights = light.weights;
  out.weights.resize(out.points.size(), 1.0f);
  normalise_weights(out);
  return true;
}

void add(LightSamples& out, const Light& light, UnitPoint u) {
  out.points.push_back(place(light, u));
  out.weights.push_back(light.kind == LightKind::textured_rectangle ? texture_weight(light, u) : 1.0f);
}

double wrapped(double x) { return x - std::floor(x); }

// Set 0 stands at the cells' centres.
Vec2f shift_of_set(int set) {
  if (set == 0) return {0, 0};
  const auto f = static_cast<uint32_t>(set);
  return {static_cast<float>(radical_inverse(f, 2) - 0.5), static_cast<float>(radical_inverse(f, 3) - 0.5)};
}

// Sample i of n of the request's set. `in_plane`: of a regular grid in a rectangle, moved by `shift` cells.
UnitPoint unit_point(const LightSampleRequest& r, uint32_t i, uint32_t n, Vec2f shift, bool in_plane) {
  const auto set = static_cast<uint32_t>(r.set);
  if (r.pattern == LightPattern::halton) return halton(i + set * n, r.seed);
  const bool jitter = r.pattern == LightPattern::jittered;
  const uint32_t seed = set == 0 ? r.seed : pcg(r.seed + 0x9e3779b9U * set);
  UnitPoint u{};
  if (r.count == 0) {
    const auto w = static_cast<uint32_t>(r.width), h = static_cast<uint32_t>(r.height);
    const double dx = jitter ? random(seed, i, 0) : 0.5 + double(shift.x),
                 dy = jitter ? random(seed, i, 1) : 0.5 + double(shift.y);
    u = {(i % w + dx) / w, (i / w + dy) / h, radical_inverse(i, 5) + 0.5 / n};
  } else {
    u = lattice(i, n);
    if (jitter) u = {(i + random(seed, i, 0)) / n, u.t, random(seed, i, 2)};
  }
  if (set == 0 || jitter || in_plane) return u;
  // Around the light by a Kronecker sequence in three dimensions (powers of 1 / 1.2207...).
  return {wrapped(u.s + 0.8191725134 * set), wrapped(u.t + 0.6710436067 * set),
          wrapped(u.r + 0.5497004779 * set)};
}

// Lets each pixel move the set.
void rotate(LightSamples& out, const Light& light, const std::vector<UnitPoint>& units, uint32_t seed) {
  if (why_not_rotated(light)) return;
  out.move_seed = seed & 0xffffffU;
  if (light.kind == LightKind::sphere) {
    out.move = PixelMove::turn;
    out.span_u = light.center;
  } else if (out.width > 0) {
    out.move = PixelMove::shift;
    out.span_u = light.edge_u / static_cast<float>(out.width);
    out.span_v = light.edge_v / static_cast<float>(out.height);
  } else {
    out.move = PixelMove::wrap;
    out.span_u = light.edge_u, out.span_v = light.edge_v;
    for (const UnitPoint& u : units) out.units.push_back({static_cast<float>(u.s), static_cast<float>(u.t)});
  }
}

}  // namespace

LightSamples make_light_samples(const Light& light, const LightSampleRequest& request) {
  LightSamples out;
  if (single(light, out) || point_set(light, out)) return out;
  const bool grid = request.count == 0, rotated = request.rotation == LightRotation::per_pixel;
  const auto w = static_cast<uint32_t>(request.width), h = static_cast<uint32_t>(request.height);
  const uint32_t n = grid ? w * h : static_cast<uint32_t>(request.count);
  const bool in_plane = grid && request.pattern == LightPattern::regular && light.kind != LightKind::sphere;
  LightSampleRequest set = request;
  if (rotated) set.set = 0;
  if (in_plane) {
    out.width = request.width, out.height = request.height;
    out.grid_shift = shift_of_set(set.set);
  }
  std::vector<UnitPoint> units;
  for (uint32_t i = 0; i < n; ++i) units.push_back(unit_point(set, i, n, out.grid_shift, in_plane));
  for (const UnitPoint& u : units) add(out, light, u);
  if (rotated)
    rotate(out, light, units, pcg(request.seed + 0x51ed270bU * static_cast<uint32_t>(request.set)));
  normalise_weights(out);
  return out;
}

std::optional<std::string> why_not_rotated(const Light& light) {
  if (light.kind == LightKind::volume)
    return "A volume light is its set of samples: it has no symmetry about which pixels could rotate them.";
  if (light.kind == LightKind::textured_rectangle)
    return "A textured light's samples have weights of their places: pixels that move them would need "
           "weights "
           "of their own.";
  return std::nullopt;
}

std::optional<std::string> why_not_jittered(const Light& light) {
  if (light.kind == LightKind::volume)
    return "A volume light is its set of samples: frames have no other set to accumulate.";
  return std::nullopt;
}

Vec2f LightSamples::draw(std::size_t pixel) const {
  using namespace light_rotation;
  const auto n = static_cast<uint32_t>(pixel);
  Vec2f d;
  if (move == PixelMove::turn)
    rotation_turn(n, move_seed, d.x, d.y);
  else if (move != PixelMove::none)
    d = {rotation_unit(n, move_seed, 0), rotation_unit(n, move_seed, 1)};
  return move == PixelMove::shift ? Vec2f{d.x - 0.5f, d.y - 0.5f} : d;
}

Vec4f LightSamples::at(std::size_t i, Vec2f drawn) const {
  const Vec4f p = points[i];
  if (move == PixelMove::none) return p;
  if (move == PixelMove::turn) {
    const float x = p.x - span_u.x, z = p.z - span_u.z;
    return {span_u.x + (drawn.x * x + drawn.y * z), p.y, span_u.z + (drawn.x * z - drawn.y * x), p.w};
  }
  if (move == PixelMove::wrap) {
    if (units[i].x + drawn.x >= 1) drawn.x -= 1;
    if (units[i].y + drawn.y >= 1) drawn.y -= 1;
  }
  const Vec3f moved = p.xyz() + (span_u * drawn.x + span_v * drawn.y);
  return {moved.x, moved.y, moved.z, p.w};
}

std::span<const Vec4f> LightSamples::of_pixel(std::size_t pixel, std::vector<Vec4f>& storage) const {
  if (move == PixelMove::none) return points;
  const Vec2f drawn = draw(pixel);
  storage.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) storage[i] = at(i, drawn);
  return storage;
}

Box LightSamples::bounds() const {
  Box box;
  for (const Vec4f& p : points) box.extend(p.xyz());
  const Box own = box;
  if (move == PixelMove::shift || move == PixelMove::wrap) {
    // A sample that wraps around stays in the rectangle, which reaches from it as far as its place says.
    const Vec2f place = move == PixelMove::wrap ? units.front() : Vec2f{};
    const Vec3f first = points.front().xyz() - span_u * place.x - span_v * place.y;
    for (const float s : {0.0f, 1.0f})
      for (const float t : {0.0f, 1.0f}) {
        if (move == PixelMove::wrap) box.extend(first + span_u * s + span_v * t);
        const Vec3f half = span_u * (s - 0.5f) + span_v * (t - 0.5f);
        if (move == PixelMove::shift) box.extend(own.lo + half), box.extend(own.hi + half);
      }
  } else if (move == PixelMove::turn) {
    float radius = 0;
    for (const Vec4f& p : points) radius = std::max(radius, std::hypot(p.x - span_u.x, p.z - span_u.z));
    for (const float side : {-1.0f, 1.0f})
      box.extend({span_u.x + side * radius, own.lo.y, span_u.z + side * radius});
  }
  return box;
}

LightSamples make_reference_samples(const Light& light, int n, uint32_t seed) {
  LightSamples out;
  if (single(light, out) || point_set(light, out)) return out;
  for (uint32_t i = 0; i < static_cast<uint32_t>(n); ++i) {
    const uint32_t shuffled = scramble(i, pcg(seed));
    const double r = radical_inverse(shuffled, 3) + random(seed, 0, 7);
    add(out, light,
        {unit(scramble(reverse_bits(shuffled), pcg(seed + 0x9e3779b9U))),
         unit(scramble(sobol_1(shuffled), pcg(seed + 0x3c6ef372U))), r - std::floor(r)});
  }
  normalise_weights(out);
  return out;
}

}  // namespace penumbra
