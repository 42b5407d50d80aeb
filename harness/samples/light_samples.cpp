#include "samples/light_samples.h"

#include <cmath>
#include <numbers>

namespace penumbra {
namespace {

// A well-mixed 32-bit hash [Jarzynski 2020, PCG].
uint32_t pcg(uint32_t v) {
  const uint32_t state = v * 747796405U + 2891336453U;
  const uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
  return (word >> 22U) ^ word;
}

double unit(uint32_t bits) { return double(bits) * 0x1p-32; }

// A random number in [0, 1) for sample i, dimension d.
double random(uint32_t seed, uint32_t i, uint32_t d) { return unit(pcg(pcg(pcg(seed) + i) + d)); }

double radical_inverse(uint32_t i, uint32_t base) {
  double inverse = 1, value = 0;
  for (; i; i /= base) value += (inverse /= base) * (i % base);
  return value;
}

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

}  // namespace

LightSamples make_light_samples(const Light& light, const LightSampleRequest& request) {
  LightSamples out;
  if (single(light, out) || point_set(light, out)) return out;
  const bool grid = request.count == 0;
  const auto w = static_cast<uint32_t>(request.width), h = static_cast<uint32_t>(request.height);
  const uint32_t n = grid ? w * h : static_cast<uint32_t>(request.count);
  for (uint32_t i = 0; i < n; ++i) {
    UnitPoint u{};
    if (request.pattern == LightPattern::halton) {
      u = halton(i, request.seed);
    } else if (grid) {
      const bool jitter = request.pattern == LightPattern::jittered;
      const double dx = jitter ? random(request.seed, i, 0) : 0.5,
                   dy = jitter ? random(request.seed, i, 1) : 0.5;
      u = {(i % w + dx) / w, (i / w + dy) / h, (radical_inverse(i, 5) + 0.5 / n)};
    } else {
      u = lattice(i, n);
      if (request.pattern == LightPattern::jittered)
        u = {(i + random(request.seed, i, 0)) / n, u.t, random(request.seed, i, 2)};
    }
    add(out, light, u);
  }
  if (grid && request.pattern == LightPattern::regular && light.kind != LightKind::sphere)
    out.width = request.width, out.height = request.height;
  normalise_weights(out);
  return out;
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
