#include "metrics/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::flip_filters {
namespace {

constexpr double pi = std::numbers::pi;

// Contrast sensitivity of an opponent channel, table 1: a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees.
struct Gaussian {
  double a, b;
};
constexpr Gaussian achromatic{1, 0.0047}, red_green{1, 0.0053},
    blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
// Width of the feature detectors in degrees.
constexpr double feature_width = 0.082;

// Weights of f at -radius ... radius, scaled so that the positive ones sum to 1, and the negative ones to -1.
template <class F>
Kernel normalised(int radius, F f) {
  double positive = 0, negative = 0;
  for (int k = -radius; k <= radius; ++k) (f(k) > 0 ? positive : negative) += f(k);
  Kernel kernel;
  for (int k = -radius; k <= radius; ++k)
    kernel.weights.push_back(static_cast<float>(f(k) > 0   ? f(k) / positive
                                                : f(k) < 0 ? f(k) / -negative
                                                           : 0));
  return kernel;
}

// Without the ends that no float sum can tell from 0: the narrow channels fill but half of the common window.
Kernel trimmed(Kernel kernel) {
  std::vector<float>& w = kernel.weights;
  while (w.size() > 1 && std::abs(w.front()) < 1e-8f && std::abs(w.back()) < 1e-8f)
    w.pop_back(), w.erase(w.begin());
  return kernel;
}

double falloff(const Gaussian& g, double degrees) { return std::exp(-pi * pi * degrees * degrees / g.b); }

void make_contrast_sensitivity(Filters& f, double pixels_per_degree) {
  // Three standard deviations of the widest Gaussian, whose b is 2 pi^2 sigma^2; the same window for all
  // channels.
  const int radius =
      static_cast<int>(std::ceil(3 * std::sqrt(blue_yellow[0].b / (2 * pi * pi)) * pixels_per_degree));
  const auto gaussian = [&](const Gaussian& g) {
    return trimmed(normalised(radius, [&](int k) { return falloff(g, k / pixels_per_degree); }));
  };
  f.y = gaussian(achromatic), f.cx = gaussian(red_green);
  // The sum of two is scaled as a whole: each keeps the share that it has of the two-dimensional sum.
  double mass[2];
  for (int i = 0; i < 2; ++i) {
    double sum = 0;
    for (int k = -radius; k <= radius; ++k) sum += falloff(blue_yellow[i], k / pixels_per_degree);
    mass[i] = blue_yellow[i].a * std::sqrt(pi / blue_yellow[i].b) * sum * sum;
  }
  for (int i = 0; i < 2; ++i) {
    f.cz_horizontal[i] = f.cz_vertical[i] = gaussian(blue_yellow[i]);
    for (float& w : f.cz_vertical[i].weights) w *= static_cast<float>(mass[i] / (mass[0] + mass[1]));
  }
}

void make_feature_detectors(Filters& f, double pixels_per_degree) {
  const double sigma = 0.5 * feature_width * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto bell = [&](int k) { return std::exp(-0.5 * k * k / (sigma * sigma)); };
  f.smooth = normalised(radius, bell);
  f.edge = normalised(radius, [&](int k) { return -k * bell(k); });
  f.point = normalised(radius, [&](int k) { return (k * k / (sigma * sigma) - 1) * bell(k); });
}

}  // namespace

Filters make_filters(double pixels_per_degree) {
  Filters f;
  make_contrast_sensitivity(f, pixels_per_degree);
  make_feature_detectors(f, pixels_per_degree);
  for (const Kernel* k : {&f.y, &f.cx, &f.cz_horizontal[0], &f.cz_horizontal[1], &f.smooth})
    f.radius = std::max(f.radius, k->radius());
  return f;
}

}  // namespace penumbra::flip_filters
