// Small scenes with known shadows, and a runner of one technique on them.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "gpu/device.h"
#include "gpu/pass_recorder.h"
#include "reference/reference.h"
#include "techniques/common/shadow_maps/fitter.h"
#include "techniques/shadow_map/shadow_map.h"

namespace penumbra::test {

inline void add_triangle(Geometry& g, Vec3f a, Vec3f b, Vec3f c) {
  const Vec3f n = normalize(cross(b - a, c - a));
  for (Vec3f p : {a, b, c}) {
    g.indices.push_back(static_cast<uint32_t>(g.positions.size()));
    g.positions.push_back(p), g.normals.push_back(n);
    g.bounds.extend(p);
  }
  g.triangle_instance.push_back(0);
  if (g.instance_albedo.empty()) g.instance_albedo.push_back({0.7f, 0.7f, 0.7f});
}

// Counter-clockwise seen from the side that u x v points to.
inline void add_quad(Geometry& g, Vec3f corner, Vec3f u, Vec3f v) {
  add_triangle(g, corner, corner + u, corner + u + v);
  add_triangle(g, corner, corner + u + v, corner + v);
}

inline void add_ground(Geometry& g, float half, float y = 0) {
  add_quad(g, {-half, y, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
}

inline void add_box(Geometry& g, Vec3f lo, Vec3f hi) {
  const Vec3f d = hi - lo, x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
  add_quad(g, lo, y, x), add_quad(g, lo + z, x, y);
  add_quad(g, lo, z, y), add_quad(g, lo + x, y, z);
  add_quad(g, lo, x, z), add_quad(g, lo + y, z, x);
}

inline void add_sphere(Geometry& g, Vec3f center, float radius, int rings = 24) {
  const auto at = [&](int i, int j) {
    const double t = std::numbers::pi * i / rings, p = std::numbers::pi * j / rings;
    return center + Vec3f(Vec3d{std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p)}) * radius;
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) add_triangle(g, at(i, j), at(i, j + 1), at(i + 1, j));
      if (i + 1 < rings) add_triangle(g, at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }
}

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
inline Light spot_light(Vec3f position, Vec3f target, float cone_degrees) {
  Light l;
  l.kind = LightKind::spot, l.center = position, l.direction = normalize(target - position);
  l.cone_degrees = cone_degrees;
  return l;
}
inline Light rectangle_light(Vec3f center, float width, float depth) {  // shines down
  Light l;
  l.kind = LightKind::rectangle, l.center = center;
  l.edge_u = {width, 0, 0}, l.edge_v = {0, 0, depth};
  l.direction = normalize(cross(l.edge_u, l.edge_v));
  return l;
}

// The ground, a box and a sphere above it, seen from the side.
inline Frame box_and_sphere(const Light& light) {
  Frame f;
  add_ground(f.geometry, 4);
  add_box(f.geometry, {-1.5f, 0.25f, -0.5f}, {-0.5f, 1.25f, 0.5f});
  add_sphere(f.geometry, {0.9f, 1.0f, 0.2f}, 0.6f);
  f.light = light;
  f.camera.eye = {0.5f, 3.5f, 6}, f.camera.target = {0, 0.4f, 0};
  return f;
}

inline gpu::Device& device() {
  static gpu::Device d{gpu::DeviceOptions{}};
  return d;
}

// A bias that is right for these scenes and unfiltered maps.
inline ParamValues unfiltered(std::initializer_list<ParamValues::value_type> more = {}) {
  ParamValues v{{"pcf_kernel", int64_t{1}}, {"slope_bias", 1.5}, {"constant_bias", 2e-5}};
  for (const auto& m : more) v[m.first] = m.second;
  return v;
}

struct Rendered {
  std::vector<float> visibility;
  Counters counters;
  std::vector<gpu::PassTime> passes;
};

// One frame's geometry and view samples on the device, shared by many renders.
class Stage {
 public:
  Stage(Frame f, int width, int height)
      : frame(std::move(f)), passes(device()), view(device(), width, height) {
    geometry.update(device(), frame, passes);
    view.render(frame, geometry, passes);
    passes.finish();
    the_case.device = &device(), the_case.frame = &frame, the_case.geometry = &geometry;
    the_case.width = width, the_case.height = height;
    visibility = gpu::Buffer(device(), sizeof(float) * pixels(), gpu::Memory::device, "visibility");
  }
  ~Stage() {
    EXPECT_TRUE(device().validation_enabled());
    EXPECT_TRUE(device().validation_messages().empty()) << device().validation_messages().front();
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  std::size_t pixels() const {
    return static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height());
  }

  std::unique_ptr<Technique> make(const ParamValues& given) {
    const TechniqueInfo info = shadow_map_technique();
    return info.make(resolve(info.params, given, "test"));
  }
  static shadow_map::Params params(const ParamValues& given) {
    return shadow_map::param_table().read(resolve(shadow_map_technique().params, given, "test"));
  }
  // What the maps cover this frame.
  shadow_map::Fitted fit(const ParamValues& given) {
    shadow_map::Fitter fitter(params(given));
    fitter.setup(device());
    return fitter.run(the_case, light_point(frame.light), view, passes);
  }
  std::optional<std::string> supports(const ParamValues& given) { return make(given)->supports(the_case); }

  Rendered render(Technique& technique) {
    RenderInput in;
    in.scene_case = &the_case, in.view_samples = &view, in.device.visibility = &visibility;
    technique.render(in, passes);
    Rendered r;
    r.visibility.resize(pixels());
    r.passes = passes.take_times();
    gpu::download(passes, "download", visibility, r.visibility.data(), sizeof(float) * pixels());
    passes.take_times();
    r.counters = technique.counters();
    return r;
  }
  Rendered render(const ParamValues& given) {
    const std::unique_ptr<Technique> technique = make(given);
    const std::optional<std::string> reason = technique->supports(the_case);
    EXPECT_FALSE(reason.has_value()) << *reason;
    technique->setup(the_case, passes);
    technique->build(the_case, passes);
    return render(*technique);
  }

  // Embree's answer for the light's centre.
  const MatchedReference& reference() {
    if (!reference_) {
      Light hard = frame.light;
      if (hard.is_area()) hard = with_size(hard, 0);
      reference_ = std::make_unique<MatchedReference>(
          ReferenceScene(frame.geometry)
              .matched(view.host(), hard, make_light_samples(hard, {1, 1}), ReferenceOrigin::offset));
    }
    return *reference_;
  }
  // Mean absolute error over evaluated pixels.
  double error(const Rendered& r) { return error(r.visibility, reference().visibility); }
  double error(const std::vector<float>& v, const std::vector<float>& truth) {
    double sum = 0, n = 0;
    for (std::size_t i = 0; i < pixels(); ++i)
      if (reference().evaluated[i]) sum += std::abs(double(v[i]) - double(truth[i])), n += 1;
    return sum / n;
  }

  Frame frame;
  gpu::PassRecorder passes;
  GeometryOnDevice geometry;
  ViewSamples view;
  Case the_case;
  gpu::Buffer visibility;

 private:
  std::unique_ptr<MatchedReference> reference_;
};

inline double number(const Counters& c, const std::string& name) { return std::get<double>(c.at(name)); }

}  // namespace penumbra::test
