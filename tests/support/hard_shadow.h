// The truth about hard shadows: Embree at the same view samples and origin, and the double-precision oracle
// for what differs from it. Header only, as stage.h.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <vector>

#include "reference/reference.h"
#include "tests/support/brute_force.h"
#include "tests/support/stage.h"

namespace penumbra::testing {

class HardShadow {
 public:
  explicit HardShadow(Stage& stage, ReferenceOrigin origin = ReferenceOrigin::exact)
      : stage_(stage),
        light_(at_its_center(stage.frame.light)),
        origin_(origin),
        reference_(stage.reference(origin)),
        oracle_(stage.frame.geometry) {}

  const MatchedReference& reference() const { return reference_; }

  // Evaluated pixels that are not as in the reference.
  std::vector<std::size_t> differing(const Rendered& r) const {
    std::vector<std::size_t> off;
    for (std::size_t i = 0; i < stage_.pixels(); ++i)
      if (reference_.evaluated[i] && r.visibility[i] != reference_.visibility[i]) off.push_back(i);
    return off;
  }

  // In double precision the pixel has the technique's answer when P moves on its surface by at most this
  // share of a pixel.
  bool flips(std::size_t pixel, bool blocked, double share) const {
    for (const double reach : {0.0, 0.25, 0.5, 1.0})
      for (int k = 0; k < 32; ++k) {
        const double angle = 2 * std::numbers::pi * k / 32;
        const double x = std::cos(angle) * reach * share, y = std::sin(angle) * reach * share;
        if (blocked_at(pixel, moved(pixel, x, y)) == blocked) return true;
      }
    return false;
  }

  // At most `share` of the evaluated pixels differ, each of them by a move of 1/64 of a pixel.
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
    for (const std::size_t i : off)
      EXPECT_TRUE(flips(i, r.visibility[i] == 0, 1.0 / 64))
          << "pixel " << i % width << ", " << i / width << " is " << r.visibility[i];
  }

 private:
  const ViewSamplesHost& view() const { return stage_.view.host(); }

  // Where the ray through (x, y) pixels beside the centre meets the plane of the pixel's surface.
  Vec3d moved(std::size_t pixel, double x, double y) const {
    const Camera& camera = stage_.frame.camera;
    const auto width = static_cast<std::size_t>(view().width);
    const double cx = double(pixel % width) + 0.5, cy = double(pixel / width) + 0.5;
    const Vec3d p(view().position[pixel].xyz()), n(view().geometric_normal[pixel].xyz()), eye(camera.eye);
    const auto hit = [&](double px, double py) {
      const Vec3d d = camera.ray_direction(px, py, view().width, view().height);
      return d * (dot(n, p - eye) / dot(n, d));
    };
    // Relative to the centre: P itself is rounded to float, which must not count as a move.
    return p + (hit(cx + x, cy + y) - hit(cx, cy));
  }
  bool blocked_at(std::size_t pixel, Vec3d p) const {
    const Vec3d n(view().geometric_normal[pixel].xyz());
    const Vec4f sample = stage_.light_samples.points[0];
    const Vec4d towards{sample.x, sample.y, sample.z, sample.w};
    if (judge_horizon(light_, p, n, towards).blocked) return true;
    if (origin_ == ReferenceOrigin::exact) return oracle_.blocked(p, towards, view().triangle[pixel]);
    const Vec3d offset = Vec3d(view().origin[pixel].xyz()) - Vec3d(view().position[pixel].xyz());
    return oracle_.blocked(p + offset, towards);
  }

  const Stage& stage_;
  Light light_;
  ReferenceOrigin origin_;
  const MatchedReference& reference_;
  BruteForce oracle_;
};

// Of the scenes of configs/scenes.
inline Frame scene_frame(const std::string& name, const std::string& light, const std::string& camera = "") {
  return Scene::load(name, {"configs/scenes"}).frame(0, light, camera, -1);
}

}  // namespace penumbra::testing
