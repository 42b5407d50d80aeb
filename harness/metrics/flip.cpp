// LDR-FLIP [Andersson 2020]. Two pipelines: what the eye still sees of the colours at a given number of
// pixels per degree (section 4.1), and edges and points (section 4.2), which raise the colour difference
// where they differ. The image is cut into tiles: what they need stays in the cache, a tile whose
// surroundings are equal in both images is known to be 0, and as every pixel is computed on its own, tiles
// may run in any order.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "metrics/checks.h"
#include "metrics/flip_color.h"
#include "metrics/flip_filters.h"
#include "metrics/metrics.h"

namespace penumbra {
namespace {

using flip_filters::Filters;
using flip_filters::Kernel;

// Section 4.1.3: the exponent, and the two numbers that stretch small differences.
constexpr float q_c = 0.7f, p_c = 0.4f, p_t = 0.95f;

constexpr int tile_width = 128, tile_height = 64;
constexpr std::size_t tile_pixels = std::size_t{tile_width} * tile_height;
constexpr int block = 16;  // outputs of a filter that are summed in registers
static_assert(tile_width % block == 0);

struct View {
  std::span<const Vec3f> rgb;
  int width, height;
  const Vec3f* row(int y) const {
    return &rgb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width)];
  }
};

using Plane = std::vector<float>;

// Four floats at once: GCC keeps plain arrays of sums in registers only by shuffling them about, at half the
// speed. Each lane adds in the order of the taps, so that a pixel's value does not depend on its lane.
using Lanes = float __attribute__((vector_size(16)));

Lanes load(const float* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

void add_to(float* p, Lanes v) {
  const Lanes sum = load(p) + v;
  std::memcpy(p, &sum, sizeof sum);
}

// out[x] += the sum of weights[k] * in[x + k * step], for a tile's width.
void add_filtered(const float* in, std::size_t step, const Kernel& kernel, float* out) {
  for (int x = 0; x < tile_width; x += block) {
    Lanes a{}, b{}, c{}, d{};
    const float* tap = in + x;
    for (const float weight : kernel.weights) {
      a += weight * load(tap), b += weight * load(tap + 4), c += weight * load(tap + 8),
          d += weight * load(tap + 12);
      tap += step;
    }
    add_to(out + x, a), add_to(out + x + 4, b), add_to(out + x + 8, c), add_to(out + x + 12, d);
  }
}

// One image's part in a tile: its filtered opponent colours, and the strength of edges and points.
struct TileResult {
  std::array<Plane, 3> color;
  Plane edge, point;
};

// Reused from tile to tile. Input rows and columns begin `radius` before the tile.
class TileFilter {
 public:
  explicit TileFilter(const Filters& filters);
  void apply(const View& image, int x0, int y0, TileResult& out);

 private:
  void convert(const View& image, int x0, int y0);
  void filter_rows(const Plane& in, const Kernel& kernel, Plane& out) const;
  void filter_columns(const Plane& in, const Kernel& kernel, Plane& out) const;
  void gradient_norm(const Plane& across, const Kernel& derivative, Plane& out);

  const Filters& filters_;
  int radius_;
  std::size_t input_width_;
  int input_rows_;
  std::array<Plane, 3> input_;  // opponent colours
  Plane y_, cx_, cz_[2], smooth_, edge_, point_, dx_, dy_;
};

TileFilter::TileFilter(const Filters& filters)
    : filters_(filters),
      radius_(filters.radius),
      input_width_(static_cast<std::size_t>(tile_width + 2 * radius_)),
      input_rows_(tile_height + 2 * radius_) {
  for (Plane& p : input_) p.resize(input_width_ * static_cast<std::size_t>(input_rows_));
}

// Beyond its border the image is continued by its border pixels.
void TileFilter::convert(const View& image, int x0, int y0) {
  for (int r = 0; r < input_rows_; ++r) {
    const Vec3f* row = image.row(std::clamp(y0 - radius_ + r, 0, image.height - 1));
    const std::size_t start = static_cast<std::size_t>(r) * input_width_;
    for (std::size_t c = 0; c < input_width_; ++c) {
      const int x = std::clamp(x0 - radius_ + static_cast<int>(c), 0, image.width - 1);
      const Vec3f color = flip_color::opponent_from_linear(row[x]);
      for (std::size_t i = 0; i < 3; ++i) input_[i][start + c] = color[static_cast<int>(i)];
    }
  }
}

void TileFilter::filter_rows(const Plane& in, const Kernel& kernel, Plane& out) const {
  out.assign(static_cast<std::size_t>(input_rows_) * tile_width, 0);
  const std::size_t first = static_cast<std::size_t>(radius_ - kernel.radius());
  for (std::size_t r = 0; r < static_cast<std::size_t>(input_rows_); ++r)
    add_filtered(&in[r * input_width_ + first], 1, kernel, &out[r * tile_width]);
}

void TileFilter::filter_columns(const Plane& in, const Kernel& kernel, Plane& out) const {
  const std::size_t first = static_cast<std::size_t>(radius_ - kernel.radius());
  for (std::size_t r = 0; r < tile_height; ++r)
    add_filtered(&in[(r + first) * tile_width], tile_width, kernel, &out[r * tile_width]);
}

void TileFilter::gradient_norm(const Plane& across, const Kernel& derivative, Plane& out) {
  dx_.assign(tile_pixels, 0), dy_.assign(tile_pixels, 0), out.resize(tile_pixels);
  filter_columns(across, filters_.smooth, dx_);
  filter_columns(smooth_, derivative, dy_);
  for (std::size_t i = 0; i < tile_pixels; ++i) out[i] = std::sqrt(dx_[i] * dx_[i] + dy_[i] * dy_[i]);
}

void TileFilter::apply(const View& image, int x0, int y0, TileResult& out) {
  convert(image, x0, y0);
  for (Plane& p : out.color) p.assign(tile_pixels, 0);
  filter_rows(input_[0], filters_.y, y_), filter_columns(y_, filters_.y, out.color[0]);
  filter_rows(input_[1], filters_.cx, cx_), filter_columns(cx_, filters_.cx, out.color[1]);
  for (int i = 0; i < 2; ++i) {
    filter_rows(input_[2], filters_.cz_horizontal[i], cz_[i]);
    filter_columns(cz_[i], filters_.cz_vertical[i], out.color[2]);
  }
  // Features are found in the achromatic channel, scaled to [0, 1]: in the errata (Y + 16) / 116, our y.
  filter_rows(input_[0], filters_.smooth, smooth_);
  filter_rows(input_[0], filters_.edge, edge_);
  filter_rows(input_[0], filters_.point, point_);
  gradient_norm(edge_, filters_.edge, out.edge);
  gradient_norm(point_, filters_.point, out.point);
}

// Section 4.1.3: the largest difference there is (green to blue) becomes 1, and p_c of it already p_t.
float color_difference(Vec3f reference, Vec3f test) {
  if (reference == test) return 0;
  const auto distance = [](Vec3f a, Vec3f b) {
    return std::pow(
        flip_color::hyab(flip_color::hunt_lab_from_opponent(a), flip_color::hunt_lab_from_opponent(b)), q_c);
  };
  static const float largest =
      distance(flip_color::opponent_from_linear({0, 1, 0}), flip_color::opponent_from_linear({0, 0, 1}));
  static const float knee = p_c * largest;
  const float d = distance(reference, test);
  return d < knee ? d * (p_t / knee) : std::min(p_t + (d - knee) / (largest - knee) * (1 - p_t), 1.0f);
}

// Section 4.2.2; the exponent q_f is 1/2.
float feature_difference(float edge_difference, float point_difference) {
  const float d = std::max(std::abs(edge_difference), std::abs(point_difference));
  return std::sqrt(std::min(d / std::numbers::sqrt2_v<float>, 1.0f));
}

void compare_tile(const TileResult& a, const TileResult& b, const View& image, int x0, int y0, float* map) {
  for (int y = y0; y < std::min(y0 + tile_height, image.height); ++y) {
    float* out = map + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    std::size_t i = static_cast<std::size_t>(y - y0) * tile_width;
    for (int x = x0; x < std::min(x0 + tile_width, image.width); ++x, ++i) {
      const float color = color_difference({a.color[0][i], a.color[1][i], a.color[2][i]},
                                           {b.color[0][i], b.color[1][i], b.color[2][i]});
      const float feature = feature_difference(a.edge[i] - b.edge[i], a.point[i] - b.point[i]);
      // Equation 10. No difference of colour is none at all, unless features differ as much as they can (0^0
      // = 1).
      out[x] = color > 0 || feature >= 1 ? std::pow(color, 1 - feature) : 0;
    }
  }
}

bool equal_around_tile(const View& a, const View& b, int x0, int y0, int radius) {
  const int begin = std::max(0, x0 - radius), end = std::min(a.width, x0 + tile_width + radius);
  const std::size_t bytes = static_cast<std::size_t>(end - begin) * sizeof(Vec3f);
  for (int y = std::max(0, y0 - radius); y < std::min(a.height, y0 + tile_height + radius); ++y)
    if (std::memcmp(a.row(y) + begin, b.row(y) + begin, bytes) != 0) return false;
  return true;
}

// `map` is zeroed.
void compare_images(const View& reference, const View& test, const Filters& filters, float* map) {
  const int columns = (reference.width + tile_width - 1) / tile_width;
  const int rows = (reference.height + tile_height - 1) / tile_height;
  parallel_for(static_cast<std::size_t>(columns * rows), 8, [&](std::size_t begin, std::size_t end) {
    TileFilter filter(filters);
    TileResult a, b;
    for (int tile = static_cast<int>(begin); tile < static_cast<int>(end); ++tile) {
      const int x0 = tile % columns * tile_width, y0 = tile / columns * tile_height;
      if (equal_around_tile(reference, test, x0, y0, filters.radius)) continue;
      filter.apply(reference, x0, y0, a);
      filter.apply(test, x0, y0, b);
      compare_tile(a, b, reference, x0, y0, map);
    }
  });
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

  FlipResult result;
  result.map.resize(reference.size());
  compare_images({reference, width, height}, {test, width, height},
                 flip_filters::make_filters(pixels_per_degree), result.map.data());
  // In reading order: the same for any number of threads.
  double sum = 0;
  for (float v : result.map) sum += static_cast<double>(v);
  result.mean = sum / static_cast<double>(result.map.size());
  return result;
}

}  // namespace penumbra
