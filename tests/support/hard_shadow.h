// The truth about hard shadows: Embree at the same view samples and origin, and the double-precision oracle
// for what differs from it. Header only, as stage.h.
#pragma once
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "reference/reference.h"
#include "tests/support/brute_force.h"
#include "tests/support/stage.h"
#include "tests/support/triangle_tree.h"

namespace penumbra::testing {

class HardShadow {
 public:
  explicit HardShadow(Stage& stage, ReferenceOrigin origin = ReferenceOrigin::exact)
      : stage_(stage),
        light_(at_its_center(stage.frame.light)),
        origin_(origin),
        reference_(stage.reference(origin)),
        oracle_(stage.frame.geometry),
        tree_(stage.frame.geometry) {}

  const MatchedReference& reference() const { return reference_; }

  // Evaluated pixels that are not as in the reference.
  std::vector<std::size_t> differing(const Rendered& r) const {
    std::vector<std::size_t> off;
    for (std::size_t i = 0; i < stage_.pixels(); ++i)
      if (reference_.evaluated[i] && r.visibility[i] != reference_.visibility[i]) off.push_back(i);
    return off;
  }

  // In double precision the pixel has the technique's answer when P moves by at most this share of a pixel:
  // anywhere (the oracle's shortest move: a segment that comes to touch a triangle is blocked), or on its
  // surface.
  bool flips(std::size_t pixel, bool blocked, double share) const {
    if (blocked_at(pixel, position(pixel)) == blocked) return true;
    if (oracle_.explain(from(pixel, position(pixel)), towards(), own(pixel), share * pixel_width(pixel))
            .within(share * pixel_width(pixel)))
      return true;
    for (const double reach : {0.1, 0.25, 0.5, 1.0})
      for (int k = 0; k < 32; ++k) {
        const double angle = k * std::numbers::pi / 16;
        const Vec3d p = moved(pixel, std::cos(angle) * reach * share, std::sin(angle) * reach * share);
        if (blocked_at(pixel, p) == blocked) return true;
      }
    return false;
  }

  // The shadow segment begins inside a closed mesh: all that blocks it are triangles of closed meshes that
  // face the light, through which it leaves. A technique whose casters are only those that turn away from the
  // light must say lit there.
  bool begins_inside(std::size_t pixel) const {
    const Geometry& g = stage_.frame.geometry;
    const Vec3d o = from(pixel, position(pixel));
    const Vec4d l = towards();
    const Segment s{o, l.w != 0 ? l.xyz() - o : l.xyz() * (2 * tree_.diagonal())};
    bool blocked = false, only = true;
    tree_.visit(s, 0, [&](uint32_t t) {
      const Triangle& c = tree_.triangle(t);
      if (t == own(pixel) || !meet(s, c)) return false;
      blocked = true;
      only = g.in_closed_mesh(t) && dot(cross(c[1] - c[0], c[2] - c[0]), s.along) > 0;
      return !only;
    });
    return blocked && only;
  }

  // At most `share` of the evaluated pixels differ, each of them by a move of 1/64 of a pixel, or lit because
  // its segment begins inside a closed mesh.
  void expect_exact(const Rendered& r, double share = 1e-4) const {
    const std::vector<std::size_t> off = differing(r);
    double evaluated = 0, shadowed = 0;
    for (std::size_t i = 0; i < stage_.pixels(); ++i) {
      evaluated += reference_.evaluated[i], shadowed += reference_.visibility[i] == 0;
      EXPECT_TRUE(!reference_.evaluated[i] || r.visibility[i] == 0 || r.visibility[i] == 1)
          << r.visibility[i];
    }
    EXPECT_GT(shadowed, 0.01 * evaluated);
    EXPECT_LE(double(off.size()), share * evaluated) << off.size() << " of " << evaluated;
    const auto width = static_cast<std::size_t>(view().width);
    std::size_t inside = 0;
    for (const std::size_t i : off) {
      if (flips(i, r.visibility[i] == 0, 1.0 / 64)) continue;
      ++inside;
      EXPECT_TRUE(r.visibility[i] == 1 && begins_inside(i))
          << "pixel " << i % width << ", " << i / width << " is " << r.visibility[i];
    }
    std::printf("[measured] %zu of %.0f evaluated pixels off, %zu of them inside a closed mesh\n", off.size(),
                evaluated, inside);
  }

 private:
  const ViewSamplesHost& view() const { return stage_.view.host(); }

  Vec3d position(std::size_t pixel) const { return Vec3d(view().position[pixel].xyz()); }
  // Where the shadow segment of a view sample at p begins, and the triangle that it leaves out.
  Vec3d from(std::size_t pixel, Vec3d p) const {
    if (origin_ == ReferenceOrigin::exact) return p;
    return p + (Vec3d(view().origin[pixel].xyz()) - position(pixel));
  }
  uint32_t own(std::size_t pixel) const {
    return origin_ == ReferenceOrigin::exact ? view().triangle[pixel] : no_triangle;
  }
  Vec4d towards() const {
    const Vec4f l = stage_.light_samples.points[0];
    return {l.x, l.y, l.z, l.w};
  }
  double pixel_width(std::size_t pixel) const {
    const double fov = double(stage_.frame.camera.vertical_fov_degrees) * std::numbers::pi / 180;
    return 2 * std::tan(0.5 * fov) / view().height * double(view().position[pixel].w);
  }
  // P moved by x, y pixels on the plane of its surface.
  Vec3d moved(std::size_t pixel, double x, double y) const {
    const Camera& camera = stage_.frame.camera;
    const auto width = static_cast<std::size_t>(view().width);
    const double cx = double(pixel % width) + 0.5, cy = double(pixel / width) + 0.5;
    const Vec3d p = position(pixel), n(view().geometric_normal[pixel].xyz()), eye(camera.eye);
    const auto hit = [&](double px, double py) {
      const Vec3d d = camera.ray_direction(px, py, view().width, view().height);
      return d * (dot(n, p - eye) / dot(n, d));
    };
    // Relative to the centre: that P itself is rounded to float must not count as a move.
    return p + (hit(cx + x, cy + y) - hit(cx, cy));
  }
  bool blocked_at(std::size_t pixel, Vec3d p) const {
    const Vec3d n(view().geometric_normal[pixel].xyz());
    return judge_horizon(light_, p, n, towards()).blocked ||
           oracle_.blocked(from(pixel, p), towards(), own(pixel));
  }

  const Stage& stage_;
  Light light_;
  ReferenceOrigin origin_;
  const MatchedReference& reference_;
  BruteForce oracle_;
  TriangleTree tree_;
};

// Of the scenes of configs/scenes.
inline Frame scene_frame(const std::string& name, const std::string& light, const std::string& camera = "") {
  return Scene::load(name, {"configs/scenes"}).frame(0, light, camera, -1);
}

}  // namespace penumbra::testing
