// One frame on the device, techniques run on it, and the truth about its hard shadows: Embree at the view
// samples themselves, and the double-precision oracle for where the two differ.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "gpu/device.h"
#include "gpu/pass_recorder.h"
#include "reference/reference.h"
#include "technique/technique.h"
#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"

namespace penumbra::test {

inline gpu::Device& device() {
  static gpu::Device d{gpu::DeviceOptions{}};
  return d;
}

struct Rendered {
  std::vector<float> visibility;
  std::vector<uint8_t> evaluated;  // as the technique narrows it; empty = everywhere
  Counters counters;
};

class Stage {
 public:
  Stage(Frame f, int width, int height)
      : frame(std::move(f)), passes(device()), view(device(), width, height) {
    geometry.update(device(), frame, passes);
    view.render(frame, geometry, passes);
    passes.finish();
    the_case.device = &device(), the_case.frame = &frame, the_case.geometry = &geometry;
    the_case.light_samples = &light_samples;
    the_case.width = width, the_case.height = height;
    light_samples = make_light_samples(frame.light, {});
    visibility = gpu::Buffer(device(), sizeof(float) * pixels(), gpu::Memory::device, "visibility");
  }
  ~Stage() {
    EXPECT_TRUE(device().validation_enabled());
    EXPECT_TRUE(device().validation_messages().empty()) << device().validation_messages().front();
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  std::size_t pixels() const { return view.host().pixel_count(); }

  static std::unique_ptr<Technique> make(const TechniqueInfo& info, const ParamValues& given) {
    return info.make(resolve(info.params, given, "test"));
  }
  Rendered render(Technique& technique) {
    RenderInput in;
    in.scene_case = &the_case, in.view_samples = &view, in.device.visibility = &visibility;
    technique.render(in, passes);
    Rendered r;
    r.visibility.resize(pixels());
    gpu::download(passes, "download", visibility, r.visibility.data(), sizeof(float) * pixels());
    passes.take_times();
    r.counters = technique.counters();
    r.evaluated = technique.evaluated_mask();
    return r;
  }
  Rendered render(const TechniqueInfo& info, const ParamValues& given) {
    const std::unique_ptr<Technique> technique = make(info, given);
    const std::optional<std::string> reason = technique->supports(the_case);
    EXPECT_FALSE(reason.has_value()) << *reason;
    technique->setup(the_case, passes);
    technique->build(the_case, passes);
    return render(*technique);
  }

  // The light as a hard-shadow technique sees it: at its centre.
  Light hard_light() const { return frame.light.is_area() ? with_size(frame.light, 0) : frame.light; }
  Vec4d towards() const {
    const Light l = hard_light();
    const Vec3d d(l.direction), c(l.center);
    return l.kind == LightKind::directional ? Vec4d{-d.x, -d.y, -d.z, 0} : Vec4d{c.x, c.y, c.z, 1};
  }
  const MatchedReference& reference() {
    if (!reference_)
      reference_ = std::make_unique<MatchedReference>(ReferenceScene(frame.geometry)
                                                          .matched(view.host(), hard_light(),
                                                                   make_light_samples(hard_light(), {1, 1}),
                                                                   ReferenceOrigin::exact));
    return *reference_;
  }
  const testing::BruteForce& oracle() {
    if (!oracle_) oracle_ = std::make_unique<testing::BruteForce>(frame.geometry);
    return *oracle_;
  }

  // Evaluated pixels of which `a` and `b` say different things.
  std::vector<std::size_t> differing(const std::vector<float>& a, const std::vector<float>& b) {
    std::vector<std::size_t> pixels_off;
    for (std::size_t i = 0; i < pixels(); ++i)
      if (reference().evaluated[i] && a[i] != b[i]) pixels_off.push_back(i);
    return pixels_off;
  }
  double share_off(const std::vector<float>& a) {
    double evaluated = 0;
    for (uint8_t e : reference().evaluated) evaluated += e;
    return double(differing(a, reference().visibility).size()) / evaluated;
  }
  // Pixels of which a neighbour has another reference visibility.
  std::vector<uint8_t> shadow_boundary() {
    std::vector<uint8_t> boundary(pixels(), 0);
    const int w = view.width(), h = view.height();
    const auto at = [&](int x, int y) {
      return reference().visibility[std::size_t(y) * std::size_t(w) + std::size_t(x)];
    };
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, h - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, w - 1); ++u)
            if (at(u, v) != at(x, y)) boundary[std::size_t(y) * std::size_t(w) + std::size_t(x)] = 1;
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
    return oracle().explain(Vec3d(v.position[pixel].xyz()), towards(), v.triangle[pixel], reach).distance <=
           reach;
  }
  // The pixel's centre is outside the triangle that the rasteriser put there (it snaps vertices to 1/256
  // pixel): P was moved back to the triangle's rim, the depth buffer's surface goes on past it.
  bool off_its_triangle(std::size_t pixel) const {
    const Vec2f w = view.host().barycentrics[pixel];
    return w.x == 0 || w.y == 0 || w.x + w.y >= 1 - 1e-6f;
  }
  // Every difference from the reference is a tie within 1/64 pixel, in the shadow segment or in the view
  // sample.
  void expect_only_ties(const Rendered& r) {
    for (std::size_t i : differing(r.visibility, reference().visibility))
      EXPECT_TRUE(flips(i, 1.0 / 64) || off_its_triangle(i))
          << "pixel " << i % std::size_t(view.width()) << ", " << i / std::size_t(view.width()) << " is "
          << r.visibility[i];
  }

  Frame frame;
  gpu::PassRecorder passes;
  GeometryOnDevice geometry;
  ViewSamples view;
  LightSamples light_samples;
  Case the_case;
  gpu::Buffer visibility;

 private:
  std::unique_ptr<MatchedReference> reference_;
  std::unique_ptr<testing::BruteForce> oracle_;
};

inline double number(const Counters& c, const std::string& name) { return std::get<double>(c.at(name)); }

inline Light point_light(Vec3f position) {
  Light l;
  l.kind = LightKind::point, l.center = position;
  return l;
}
inline Light directional_light(Vec3f direction) {
  Light l;
  l.kind = LightKind::directional, l.direction = normalize(direction);
  return l;
}
inline Camera camera(Vec3f eye, Vec3f target, float near_plane = 0.01f) {
  Camera c;
  c.eye = eye, c.target = target, c.near_plane = near_plane;
  return c;
}

}  // namespace penumbra::test
