// LDR-FLIP [Andersson 2020]. Two pipelines: what the eye still sees of the colours at a given number of
// pixels per degree (sections 4.1.x), and edges and points (section 4.2), which raise the colour difference
// where they differ. All filters are sums of separable ones; every pixel is computed on its own, so bands of
// rows may run in any order.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "metrics/checks.h"
#include "metrics/flip_color.h"
#include "metrics/metrics.h"

namespace penumbra {
namespace {

constexpr double pi = std::numbers::pi;

// Section 4.1.3 and 4.2.2: exponents and the two numbers that stretch small differences.
constexpr double q_c = 0.7, p_c = 0.4, p_t = 0.95, q_f = 0.5;
// Width of the feature detectors in degrees (section 4.2.1).
constexpr double feature_width = 0.082;

// Contrast sensitivity of one opponent channel, table 1: a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees.
struct Gaussian {
  double a, b;
};
constexpr Gaussian achromatic{1, 0.0047}, red_green{1, 0.0053},
    blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

using Kernel = std::vector<float>;  // 2 radius + 1 weights
using Row = std::vector<float>;

// Weights of f at -radius ... radius, scaled so that the positive ones sum to 1, and so do the negative ones,
// negated.
template <class F>
Kernel normalised_kernel(int radius, F f) {
  double positive = 0, negative = 0;
  for (int k = -radius; k <= radius; ++k) (f(k) > 0 ? positive : negative) += f(k);
  Kernel kernel;
  for (int k = -radius; k <= radius; ++k)
    kernel.push_back(static_cast<float>(f(k) > 0 ? f(k) / positive : f(k) < 0 ? f(k) / -negative : 0));
  return kernel;
}

struct Filters {
  int color_radius, feature_radius;
  Kernel y, cx, cz[2];  // contrast sensitivity
  float cz_weight[2];   // share of each of the two Gaussians in the blue-yellow channel's filter
  Kernel smooth, edge, point;
};

double falloff(const Gaussian& g, double d) { return std::exp(-pi * pi * d * d / g.b); }

Filters make_filters(double pixels_per_degree) {
  Filters f;
  const double step = 1 / pixels_per_degree;
  // Three standard deviations of the widest Gaussian, whose b is 2 pi^2 sigma^2; the same window for all
  // channels.
  f.color_radius =
      static_cast<int>(std::ceil(3 * std::sqrt(blue_yellow[0].b / (2 * pi * pi)) * pixels_per_degree));
  const auto gaussian = [&](const Gaussian& g) {
    return normalised_kernel(f.color_radius, [&](int k) { return falloff(g, k * step); });
  };
  f.y = gaussian(achromatic), f.cx = gaussian(red_green);
  double mass[2];
  for (int i = 0; i < 2; ++i) {
    f.cz[i] = gaussian(blue_yellow[i]);
    double sum = 0;
    for (int k = -f.color_radius; k <= f.color_radius; ++k) sum += falloff(blue_yellow[i], k * step);
    mass[i] = blue_yellow[i].a * std::sqrt(pi / blue_yellow[i].b) * sum * sum;
  }
  for (int i = 0; i < 2; ++i) f.cz_weight[i] = static_cast<float>(mass[i] / (mass[0] + mass[1]));

  const double sigma = 0.5 * feature_width * pixels_per_degree;
  f.feature_radius = static_cast<int>(std::ceil(3 * sigma));
  const auto bell = [&](int k) { return std::exp(-0.5 * k * k / (sigma * sigma)); };
  f.smooth = normalised_kernel(f.feature_radius, bell);
  f.edge = normalised_kernel(f.feature_radius, [&](int k) { return -k * bell(k); });
  f.point =
      normalised_kernel(f.feature_radius, [&](int k) { return (k * k / (sigma * sigma) - 1) * bell(k); });
  return f;
}

// A band of rows of one channel, with the rows above and below that a vertical filter needs.
struct Plane {
  Plane(int width, int rows)
      : width_(static_cast<std::size_t>(width)), values_(width_ * static_cast<std::size_t>(rows)) {}
  float* row(int y) { return &values_[static_cast<std::size_t>(y) * width_]; }
  const float* row(int y) const { return &values_[static_cast<std::size_t>(y) * width_]; }

 private:
  std::size_t width_;
  std::vector<float> values_;
};

// out = in filtered along the row, which is continued by its end pixels.
void filter_row(const float* in, float* out, int width, const Kernel& kernel, Row& padded) {
  const std::size_t n = static_cast<std::size_t>(width), radius = kernel.size() / 2;
  padded.resize(n + 2 * radius);
  std::fill_n(padded.begin(), radius, in[0]);
  std::copy_n(in, n, padded.begin() + static_cast<std::ptrdiff_t>(radius));
  std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, in[n - 1]);
  std::fill_n(out, n, 0.0f);
  for (std::size_t k = 0; k < kernel.size(); ++k) {
    const float weight = kernel[k];
    const float* shifted = padded.data() + k;
    for (std::size_t x = 0; x < n; ++x) out[x] += weight * shifted[x];
  }
}

// out += scale * (plane filtered along columns at `center`); rows center - radius ... center + radius exist.
void add_column(const Plane& plane, int center, float* out, int width, const Kernel& kernel,
                float scale = 1) {
  const int radius = static_cast<int>(kernel.size() / 2);
  for (int k = -radius; k <= radius; ++k) {
    const float weight = scale * kernel[static_cast<std::size_t>(k + radius)];
    const float* in = plane.row(center + k);
    for (int x = 0; x < width; ++x) out[x] += weight * in[x];
  }
}

struct View {
  std::span<const Vec3f> rgb;
  int width, height;
};

// Of one image, the rows of a band filtered horizontally. Row i is the image's row y0 - radius + i, and
// beyond the border the border row again.
struct Band {
  Band(const View& image, const Filters& f, int y0, int rows);
  int radius;
  Plane y, cx, cz0, cz1;
  Plane smooth, edge, point;
};

Band::Band(const View& image, const Filters& f, int y0, int rows)
    : radius(std::max(f.color_radius, f.feature_radius)),
      y(image.width, rows + 2 * radius),
      cx(y),
      cz0(y),
      cz1(y),
      smooth(y),
      edge(y),
      point(y) {
  const std::size_t n = static_cast<std::size_t>(image.width);
  std::array<Row, 3> channel;
  for (Row& c : channel) c.resize(n);
  Row padded;
  int converted = -1;
  for (int i = 0; i < rows + 2 * radius; ++i) {
    const int source = std::clamp(y0 - radius + i, 0, image.height - 1);
    if (source != converted) {
      const Vec3f* rgb = &image.rgb[static_cast<std::size_t>(source) * n];
      for (std::size_t x = 0; x < n; ++x) {
        const Vec3f c = flip_color::opponent_from_linear(rgb[x]);
        channel[0][x] = c.x, channel[1][x] = c.y, channel[2][x] = c.z;
      }
      converted = source;
    }
    // Features are found in the first channel as it is: (Y + 16) / 116 in the errata of [Andersson 2020] is
    // its y.
    const auto filter = [&](std::size_t c, const Kernel& kernel, Plane& out) {
      filter_row(channel[c].data(), out.row(i), image.width, kernel, padded);
    };
    filter(0, f.y, y), filter(1, f.cx, cx), filter(2, f.cz[0], cz0), filter(2, f.cz[1], cz1);
    filter(0, f.smooth, smooth), filter(0, f.edge, edge), filter(0, f.point, point);
  }
}

// What is compared at each pixel of a row: the perceived colour (Lab with Hunt's adjustment), and the
// strength of edges and points.
struct Perceived {
  explicit Perceived(int width)
      : color(static_cast<std::size_t>(width)), edge(color.size()), point(color.size()) {}
  std::vector<Vec3f> color;
  Row edge, point;
};

void gradient_norm(const Plane& across, const Plane& smooth, int center, const Kernel& derivative,
                   const Kernel& bell, Row& out, Row& dx, Row& dy) {
  const int width = static_cast<int>(out.size());
  dx.assign(out.size(), 0), dy.assign(out.size(), 0);
  add_column(across, center, dx.data(), width, bell);
  add_column(smooth, center, dy.data(), width, derivative);
  for (std::size_t x = 0; x < out.size(); ++x) out[x] = std::sqrt(dx[x] * dx[x] + dy[x] * dy[x]);
}

void perceive(const Band& band, const Filters& f, int row, Perceived& out, std::array<Row, 3>& scratch) {
  const int center = row + band.radius, width = static_cast<int>(out.color.size());
  for (Row& r : scratch) r.assign(out.color.size(), 0);
  add_column(band.y, center, scratch[0].data(), width, f.y);
  add_column(band.cx, center, scratch[1].data(), width, f.cx);
  add_column(band.cz0, center, scratch[2].data(), width, f.cz[0], f.cz_weight[0]);
  add_column(band.cz1, center, scratch[2].data(), width, f.cz[1], f.cz_weight[1]);
  for (std::size_t x = 0; x < out.color.size(); ++x)
    out.color[x] = flip_color::hunt_lab_from_opponent({scratch[0][x], scratch[1][x], scratch[2][x]});
  gradient_norm(band.edge, band.smooth, center, f.edge, f.smooth, out.edge, scratch[0], scratch[1]);
  gradient_norm(band.point, band.smooth, center, f.point, f.smooth, out.point, scratch[0], scratch[1]);
}

// Section 4.1.3: the largest difference there is (green to blue) becomes 1, and p_c of it already p_t.
float color_difference(Vec3f reference, Vec3f test) {
  static const double largest = std::pow(
      flip_color::hyab(flip_color::hunt_lab_from_opponent(flip_color::opponent_from_linear({0, 1, 0})),
                       flip_color::hunt_lab_from_opponent(flip_color::opponent_from_linear({0, 0, 1}))),
      q_c);
  const double d = std::pow(static_cast<double>(flip_color::hyab(reference, test)), q_c),
               knee = p_c * largest;
  const double mapped = d < knee ? d * p_t / knee : p_t + (d - knee) / (largest - knee) * (1 - p_t);
  return static_cast<float>(std::min(mapped, 1.0));
}

// Section 4.2.2.
float feature_difference(float reference_edge, float test_edge, float reference_point, float test_point) {
  const float d = std::max(std::abs(reference_edge - test_edge), std::abs(reference_point - test_point));
  return static_cast<float>(std::pow(std::min(static_cast<double>(d) / std::numbers::sqrt2, 1.0), q_f));
}

void compare_rows(const View& reference, const View& test, const Filters& f, int begin, int end, float* map) {
  const Band reference_band(reference, f, begin, end - begin), test_band(test, f, begin, end - begin);
  Perceived a(reference.width), b(reference.width);
  std::array<Row, 3> scratch;
  for (int y = begin; y < end; ++y) {
    perceive(reference_band, f, y - begin, a, scratch);
    perceive(test_band, f, y - begin, b, scratch);
    float* out = map + static_cast<std::size_t>(y) * a.color.size();
    for (std::size_t x = 0; x < a.color.size(); ++x) {
      const float color = color_difference(a.color[x], b.color[x]);
      const float feature = feature_difference(a.edge[x], b.edge[x], a.point[x], b.point[x]);
      out[x] = std::pow(color, 1 - feature);  // equation 10; 0 to the power of 0 is 1, as it must be
    }
  }
}

void check(const char* what, std::span<const Vec3f> image, int width, int height) {
  check_array(what, image.size(), pixel_count(width, height));
  for (std::size_t i = 0; i < image.size(); ++i)
    for (int c = 0; c < 3; ++c) check_finite(what, image[i][c], i, width);
}

}  // namespace

FlipResult flip(std::span<const Vec3f> reference, std::span<const Vec3f> test, int width, int height,
                double pixels_per_degree) {
  if (pixel_count(width, height) == 0) throw InputError("FLIP of an image without pixels has no value.");
  if (!(pixels_per_degree > 0 && pixels_per_degree <= 10000))
    throw InputError("FLIP at " + std::to_string(pixels_per_degree) +
                     " pixels per degree; expected 0 < p <= 10000.");
  check("The reference", reference, width, height);
  check("The test image", test, width, height);

  const Filters filters = make_filters(pixels_per_degree);
  FlipResult result;
  result.map.resize(reference.size());
  parallel_for(static_cast<std::size_t>(height), 64, [&](std::size_t begin, std::size_t end) {
    compare_rows({reference, width, height}, {test, width, height}, filters, static_cast<int>(begin),
                 static_cast<int>(end), result.map.data());
  });
  // In reading order: the same for any number of threads.
  double sum = 0;
  for (float v : result.map) sum += static_cast<double>(v);
  result.mean = sum / static_cast<double>(result.map.size());
  return result;
}

}  // namespace penumbra
