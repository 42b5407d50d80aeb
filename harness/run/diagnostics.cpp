#include "run/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "image/false_color.h"

namespace penumbra::run {
namespace {

// Grids are shown at least this large.
constexpr int least_side = 512;
constexpr double figure_share = 0.8, class_share = 0.65;
// Of a line's colour, where the scene does not hide it and where it does.
constexpr double seen_share = 0.9, hidden_share = 0.16;
// A line on a surface is as deep as the surface.
constexpr double depth_slack = 2e-3;
constexpr Rgb8 outer_color{255, 255, 255}, inner_color{86, 200, 255};

// Figures as shares of the colours: logarithmic, because list lengths span decades.
class FigureScale {
 public:
  explicit FigureScale(std::span<const float> values) {
    std::vector<float> known;
    for (const float v : values)
      if (v > 0) known.push_back(v);
    pixels_ = known.size();
    if (known.empty()) return;
    high_ = *std::max_element(known.begin(), known.end());
    std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2),
                     known.end());
    median_ = known[known.size() / 2];
  }
  double operator()(double v) const { return high_ > 0 ? std::log1p(v) / std::log1p(high_) : 0; }
  nlohmann::json legend() const {
    nlohmann::json stops = nlohmann::json::array(), marks = nlohmann::json::array();
    for (const Rgb8& c : false_color_stops()) stops.push_back(hex(c));
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) marks.push_back(std::expm1(t * std::log1p(high_)));
    return {
        {"high", high_}, {"median", median_}, {"above_none", pixels_}, {"colors", stops}, {"marks", marks}};
  }

 private:
  double high_ = 0, median_ = 0;
  std::size_t pixels_ = 0;
};

void check_size(const Illustration& illustration, std::size_t found, std::size_t wanted) {
  if (found != wanted)
    throw PointError(fmt::format("the diagnostic picture '{}' has {} pixels, expected {}.", illustration.name,
                                 found, wanted));
}

nlohmann::json named_colors(const std::vector<std::string>& names) {
  nlohmann::json colors = nlohmann::json::array();
  for (std::size_t i = 0; i < names.size(); ++i) colors.push_back(hex(class_color(i)));
  return {{"names", names}, {"colors", colors}};
}

Drawn draw_content(const Illustration& illustration, const PixelFigures& figures, const Backdrop& back) {
  check_size(illustration, figures.values.size(), back.view->pixel_count());
  const FigureScale scale(figures.values);
  Drawn drawn{back.picture, back.view->width, back.view->height, figures.values, scale.legend()};
  for (std::size_t i = 0; i < figures.values.size(); ++i)
    if (figures.values[i] > 0)
      blend(drawn.picture, static_cast<int>(i) % drawn.width, static_cast<int>(i) / drawn.width,
            false_color(scale(static_cast<double>(figures.values[i]))), figure_share);
  drawn.legend["kind"] = "figures";
  return drawn;
}

Drawn draw_content(const Illustration& illustration, const PixelClasses& classes, const Backdrop& back) {
  check_size(illustration, classes.values.size(), back.view->pixel_count());
  Drawn drawn{back.picture, back.view->width, back.view->height, {}, named_colors(classes.names)};
  std::vector<std::size_t> counts(classes.names.size());
  for (std::size_t i = 0; i < classes.values.size(); ++i) {
    if (classes.values[i] >= classes.names.size()) continue;
    ++counts[classes.values[i]];
    blend(drawn.picture, static_cast<int>(i) % drawn.width, static_cast<int>(i) / drawn.width,
          class_color(classes.values[i]), class_share);
  }
  drawn.legend["kind"] = "classes";
  drawn.legend["pixels"] = counts;
  return drawn;
}

void draw_polygons(Rgb8Image& picture, const std::vector<std::vector<Vec2d>>& polygons, double factor,
                   Rgb8 color) {
  for (const std::vector<Vec2d>& p : polygons)
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec2d a = p[i], b = p[(i + 1) % p.size()];
      draw_line(picture, {a.x * factor, a.y * factor}, {b.x * factor, b.y * factor}, color,
                [](int, int, double) { return seen_share; });
    }
}

Drawn draw_content(const Illustration& illustration, const GridFigures& grid, const Backdrop&) {
  check_size(illustration, grid.values.size(),
             static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height));
  const int factor = std::max(1, least_side / std::max({grid.width, grid.height, 1}));
  const FigureScale scale(grid.values);
  Drawn drawn{{}, grid.width, grid.height, grid.values, scale.legend()};
  Rgb8Image& picture = drawn.picture;
  picture.width = grid.width * factor, picture.height = grid.height * factor;
  picture.rgb.assign(3 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height),
                     0);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const float v =
          grid.values[static_cast<std::size_t>(y / factor) * static_cast<std::size_t>(grid.width) +
                      static_cast<std::size_t>(x / factor)];
      if (v > 0) blend(picture, x, y, false_color(scale(static_cast<double>(v))), 1);
    }
  draw_polygons(picture, grid.outer, factor, outer_color);
  draw_polygons(picture, grid.inner, factor, inner_color);
  drawn.legend["kind"] = "grid";
  if (!grid.outer.empty()) {
    drawn.legend["names"] = {grid.outer_name, grid.inner_name};
    drawn.legend["line_colors"] = {hex(outer_color), hex(inner_color)};
  }
  return drawn;
}

// A point of the picture: pixel coordinates, and depth as Camera::clip_from_world makes it.
struct PicturePoint {
  Vec2d at;
  double depth = 0;
};
PicturePoint picture_point(Vec4d clip, int width, int height) {
  return {{0.5 * (clip.x / clip.w + 1) * width, 0.5 * (clip.y / clip.w + 1) * height}, clip.z / clip.w};
}

// The part of a segment that is before the near plane; false when there is none.
bool clip_to_near(Vec4d& a, Vec4d& b) {
  const double da = a.w - a.z, db = b.w - b.z, least = 1e-9 * (std::abs(a.w) + std::abs(b.w) + 1e-30);
  if (da <= least && db <= least) return false;
  const auto between = [&](double t) {
    Vec4d p;
    for (int i = 0; i < 4; ++i) p[i] = a[i] + t * (b[i] - a[i]);
    return p;
  };
  if (da < least)
    a = between((least - da) / (db - da));
  else if (db < least)
    b = between((least - da) / (db - da));
  return true;
}

Drawn draw_content(const Illustration&, const WorldLines& lines, const Backdrop& back) {
  const ViewSamplesHost& view = *back.view;
  Drawn drawn{back.picture, view.width, view.height, {}, named_colors(lines.kinds)};
  const Mat4d clip_from_world = back.camera->clip_from_world(view.width, view.height);
  const double near = static_cast<double>(back.camera->near_plane);
  std::vector<std::size_t> counts(lines.kinds.size());
  for (std::size_t kind = 0; kind < lines.kinds.size(); ++kind)
    for (const WorldLines::Segment& s : lines.segments) {
      if (s.kind != kind) continue;
      ++counts[kind];
      Vec4d a = clip_from_world * Vec4d{s.a.x, s.a.y, s.a.z, s.a.w},
            b = clip_from_world * Vec4d{s.b.x, s.b.y, s.b.z, s.b.w};
      if (!clip_to_near(a, b)) continue;
      const PicturePoint p = picture_point(a, view.width, view.height),
                         q = picture_point(b, view.width, view.height);
      draw_line(drawn.picture, p.at, q.at, class_color(kind), [&](int x, int y, double t) {
        if (x < 0 || y < 0 || x >= view.width || y >= view.height) return 0.0;
        const std::size_t i =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(x);
        if (view.triangle[i] == no_triangle) return seen_share;
        const double surface = near / static_cast<double>(view.position[i].w);
        const double depth = p.depth + t * (q.depth - p.depth);  // linear in the picture
        return depth >= surface * (1 - depth_slack) ? seen_share : hidden_share;
      });
    }
  drawn.legend["kind"] = "lines";
  drawn.legend["segments"] = counts;
  return drawn;
}

}  // namespace

Backdrop backdrop(std::span<const Vec3f> shaded, const ViewSamplesHost& view, const Camera& camera) {
  Backdrop back{{view.width, view.height, std::vector<uint8_t>(3 * shaded.size())}, &view, &camera};
  for (std::size_t i = 0; i < shaded.size(); ++i) {
    const Vec3f c = shaded[i];
    const float light = 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
    // Surfaces in shadow stay above the black of no surface.
    const bool surface = view.triangle[i] != no_triangle;
    const uint8_t grey = surface ? static_cast<uint8_t>(28 + srgb_from_linear(light) * 0.42f) : uint8_t{12};
    std::fill_n(&back.picture.rgb[3 * i], 3, grey);
  }
  return back;
}

Drawn draw(const Illustration& illustration, const Backdrop& back) {
  Drawn drawn = std::visit([&](const auto& content) { return draw_content(illustration, content, back); },
                           illustration.content);
  drawn.legend["name"] = illustration.name;
  drawn.legend["title"] = illustration.title;
  return drawn;
}

Illustration zones(std::span<const float> visibility, std::span<const uint8_t> evaluated) {
  PixelClasses classes{std::vector<uint8_t>(visibility.size(), no_class), {"umbra", "penumbra", "lit"}};
  for (std::size_t i = 0; i < visibility.size(); ++i)
    if (evaluated[i]) classes.values[i] = visibility[i] <= 0 ? 0 : visibility[i] >= 1 ? 2 : 1;
  return {"zones", "Zones of the reference: umbra (no light is seen), penumbra, lit", std::move(classes)};
}

}  // namespace penumbra::run
