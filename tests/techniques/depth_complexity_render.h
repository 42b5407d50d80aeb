// Renders a frame with depth_complexity_sampling through the technique contract, and judges it.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "reference/reference.h"
#include "techniques/depth_complexity_sampling/depth_complexity_sampling.h"
#include "tests/support/brute_force.h"
#include "tests/techniques/gears_render.h"

namespace penumbra::testing {

class DepthComplexityRun {
 public:
  explicit DepthComplexityRun(DeviceScene& scene, const ParamValues& given = {}) : scene_(scene) {
    const TechniqueInfo info = depth_complexity_sampling_technique();
    technique_ = info.make(resolve(info.params, given, "test"));
    visibility.assign(scene.view->host().pixel_count(), -7.0F);
    mask.assign(visibility.size() * static_cast<std::size_t>(scene.samples.mask_words()), 0xdeadbeefU);
  }
  Technique& technique() { return *technique_; }
  void build() {
    technique_->build(scene_.scene_case, scene_.passes);
    scene_.passes.finish();
  }
  void render() {
    RenderInput in;
    in.scene_case = &scene_.scene_case, in.view_samples = scene_.view.get(), in.host = {visibility, mask};
    technique_->render(in, scene_.passes);
  }
  double counter(const std::string& name) { return std::get<double>(technique_->counters().at(name)); }

  std::vector<float> visibility;
  std::vector<uint32_t> mask;

 private:
  DeviceScene& scene_;
  std::unique_ptr<Technique> technique_;
};

// Every differing bit is a tie, and at most one in 100,000 differs.
inline void expect_the_reference(const DeviceScene& scene, const std::vector<uint32_t>& mask,
                                 const char* name, double most = 1e-5) {
  const MatchedReference truth =
      ReferenceScene(scene.frame.geometry)
          .matched(scene.view->host(), scene.frame.light, scene.samples, ReferenceOrigin::offset);
  const BruteForce oracle(scene.frame.geometry);
  const Differences d = explain_differences(oracle, scene.frame.light, scene.samples, scene.view->host(),
                                            mask, truth.mask, truth.evaluated);
  EXPECT_GT(d.bits, 0U);
  EXPECT_LE(static_cast<double>(d.differing), std::ceil(most * static_cast<double>(d.bits)));
  EXPECT_EQ(d.unexplained, 0U) << "the worst is " << d.worst << " tolerances from a tie";
  std::printf("%s: %llu of %llu bits differ; the worst is %.3g tolerances from a tie\n", name,
              static_cast<unsigned long long>(d.differing), static_cast<unsigned long long>(d.bits), d.worst);
}

// Leaves out about that share of the triangles, but for the last `spare` ones.
inline void remove_triangles(Geometry& g, double share, std::size_t spare) {
  std::mt19937 random(3);
  Geometry out = g;
  out.indices.clear(), out.triangle_instance.clear();
  for (std::size_t t = 0; t < g.triangle_count(); ++t) {
    if (static_cast<double>(random()) * 0x1p-32 < share && t + spare < g.triangle_count()) continue;
    out.indices.insert(out.indices.end(), &g.indices[3 * t], &g.indices[3 * t] + 3);
    out.triangle_instance.push_back(g.triangle_instance[t]);
  }
  out.closed = false;
  out.instance_closed.assign(g.instance_closed.size(), 0);
  g = std::move(out);
}
inline void flip_triangles(Geometry& g, double share) {
  std::mt19937 random(5);
  for (std::size_t t = 0; t < g.triangle_count(); ++t)
    if (static_cast<double>(random()) * 0x1p-32 < share) std::swap(g.indices[3 * t], g.indices[3 * t + 1]);
  g.closed = false;
}
// Each triangle with vertices of its own, `shrink` of the way to its middle: 0 leaves them where they are.
inline void make_soup(Geometry& g, float shrink) {
  Geometry out = g;
  out.positions.clear(), out.normals.clear();
  for (std::size_t i = 0; i < g.indices.size(); ++i) {
    const std::size_t t = i / 3;
    const Vec3f middle = (g.corner(t, 0) + g.corner(t, 1) + g.corner(t, 2)) / 3.0F;
    out.positions.push_back(g.positions[g.indices[i]] + (middle - g.positions[g.indices[i]]) * shrink);
    out.normals.push_back(g.normals[g.indices[i]]);
    out.indices[i] = static_cast<uint32_t>(i);
  }
  out.closed = false;
  g = std::move(out);
}

}  // namespace penumbra::testing
