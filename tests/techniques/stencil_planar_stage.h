// Hard shadows on one stage, and where they may differ from Embree: on shadow boundaries, in ties that the
// double-precision oracle confirms.
#pragma once
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"
#include "tests/support/stage.h"
#include "tests/support/triangle_tree.h"

namespace penumbra::test {

using testing::camera_at;
using testing::device;
using testing::directional_light;
using testing::number;
using testing::point_light;
using testing::Rendered;

class Stage : public testing::Stage {
 public:
  using testing::Stage::Stage;

  Vec4d towards() const {
    const Vec4f l = light_samples.points.front();
    return {l.x, l.y, l.z, l.w};
  }
  const MatchedReference& truth() { return reference(ReferenceOrigin::exact); }
  const testing::BruteForce& oracle() {
    if (!oracle_) oracle_ = std::make_unique<testing::BruteForce>(frame.geometry);
    return *oracle_;
  }

  // Evaluated pixels of which `a` and `b` say different things.
  std::vector<std::size_t> differing(const std::vector<float>& a, const std::vector<float>& b) {
    std::vector<std::size_t> off;
    for (std::size_t i = 0; i < pixels(); ++i)
      if (truth().evaluated[i] && a[i] != b[i]) off.push_back(i);
    return off;
  }
  std::vector<std::size_t> differing(const Rendered& r) {
    return differing(r.visibility, truth().visibility);
  }
  double share_off(const Rendered& r) {
    double evaluated = 0;
    for (uint8_t e : truth().evaluated) evaluated += e;
    return double(differing(r).size()) / evaluated;
  }
  // Pixels of which a neighbour has another reference visibility.
  std::vector<uint8_t> shadow_boundary() {
    std::vector<uint8_t> boundary(pixels(), 0);
    const int w = view.width(), h = view.height();
    const auto at = [&](int x, int y) { return truth().visibility[index(x, y)]; };
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, h - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, w - 1); ++u)
            if (at(u, v) != at(x, y)) boundary[index(x, y)] = 1;
    return boundary;
  }

  // Length of a share of a pixel on the surface that it shows.
  double on_surface(std::size_t pixel, double share) const {
    const ViewSamplesHost& v = view.host();
    const Vec3d to_eye = normalize(Vec3d(frame.camera.eye) - Vec3d(v.position[pixel].xyz()));
    const double side =
        2 * std::tan(double{frame.camera.vertical_fov_degrees} * 3.14159265358979 / 360) / v.height;
    const double cosine = std::max(0.02, dot(to_eye, Vec3d(v.geometric_normal[pixel].xyz())));
    return share * side * double{v.position[pixel].w} / cosine;
  }
  // In double precision, a shadow segment whose ends move by this share of a pixel has the other answer.
  bool flips(std::size_t pixel, double share) {
    const double reach = on_surface(pixel, share);
    const ViewSamplesHost& v = view.host();
    return oracle()
        .explain(Vec3d(v.position[pixel].xyz()), towards(), v.triangle[pixel], reach)
        .within(reach);
  }
  // In double precision, the view sample of a point of the picture this share of a pixel away has the answer
  // `lit`: it may lie on another triangle.
  bool moved_is(std::size_t pixel, double share, bool lit) {
    for (const double radius : {0.25, 0.5, 1.0})
      for (int k = 0; k < 16; ++k) {
        const double angle = 3.14159265358979 * k / 8;
        if (lit_at(pixel, radius * share * std::cos(angle), radius * share * std::sin(angle)) == lit)
          return true;
      }
    return false;
  }
  // Pixels that differ from the reference although their answer does not flip when P moves by 1/64 of a
  // pixel.
  std::vector<std::size_t> no_ties(const Rendered& r) {
    std::vector<std::size_t> unexplained;
    for (std::size_t i : differing(r))
      if (!flips(i, 1.0 / 64) && !moved_is(i, 1.0 / 64, r.visibility[i] != 0)) unexplained.push_back(i);
    return unexplained;
  }
  void expect_only_ties(const Rendered& r) {
    for (std::size_t i : no_ties(r))
      ADD_FAILURE() << "pixel " << i % std::size_t(view.width()) << ", " << i / std::size_t(view.width())
                    << " is " << r.visibility[i];
  }
  // Mask bits that differ from Embree's; each must be a tie within 1/64 pixel in double precision.
  std::size_t differing_bits(const Rendered& m, std::size_t* compared) {
    const std::size_t words = mask_words();
    const ViewSamplesHost& v = view.host();
    std::size_t off = 0;
    for (std::size_t i = 0; i < pixels(); ++i) {
      if (!truth().evaluated[i] || (!m.evaluated.empty() && !m.evaluated[i])) continue;
      for (std::size_t s = 0; s < static_cast<std::size_t>(light_samples.count()); ++s) {
        const std::size_t word = i * words + s / 32;
        ++*compared;
        if (((truth().mask[word] ^ m.mask[word]) >> (s % 32) & 1) == 0) continue;
        ++off;
        const Vec4f l = light_samples.points[s];
        const Vec4d to{l.x, l.y, l.z, l.w};
        const Vec3d p(v.position[i].xyz()), n(v.geometric_normal[i].xyz());
        const double reach = on_surface(i, 1.0 / 64);
        EXPECT_TRUE(oracle().explain(p, to, v.triangle[i], reach).within(reach) ||
                    testing::judge_horizon(frame.light, p, n, to).distance <= reach)
            << "pixel " << i << ", light sample " << s;
      }
    }
    return off;
  }

 private:
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(view.width()) + std::size_t(x);
  }
  // Nothing where the point of the picture shows no surface.
  std::optional<bool> lit_at(std::size_t pixel, double dx, double dy) {
    if (!tree_) tree_ = std::make_unique<testing::TriangleTree>(frame.geometry);
    const auto width = std::size_t(view.width());
    const Vec3d ray = frame.camera.ray_direction(
        double(pixel % width) + 0.5 + dx, double(pixel / width) + 0.5 + dy, view.width(), view.height());
    const Vec3d eye(frame.camera.eye), start = eye + ray * double{frame.camera.near_plane};
    const testing::Segment s{start, ray * (2 * double{view.host().position[pixel].w})};
    const testing::TriangleTree::Hit hit = tree_->nearest(s);
    if (hit.triangle == no_triangle) return std::nullopt;
    const testing::Triangle& t = tree_->triangle(hit.triangle);
    Vec3d n = normalize(cross(t[1] - t[0], t[2] - t[0]));
    if (dot(n, ray) > 0) n = -n;
    const Light light = testing::at_its_center(frame.light);
    return !testing::judge_horizon(light, s.at(hit.t), n, towards()).blocked &&
           !oracle().blocked(s.at(hit.t), towards(), hit.triangle);
  }

  std::unique_ptr<testing::BruteForce> oracle_;
  std::unique_ptr<testing::TriangleTree> tree_;
};

}  // namespace penumbra::test
