// One frame on the device, rendered by alias_free_shadow_map and judged by Embree and by the double-precision oracle.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "reference/reference.h"
#include "techniques/alias_free_shadow_map/alias_free_shadow_map.h"
#include "tests/support/brute_force.h"
#include "tests/support/host_view.h"

namespace penumbra::test {

inline gpu::Device& device() {
  static gpu::Device d{gpu::DeviceOptions{}};
  return d;
}

struct Rendered {
  std::vector<float> visibility;
  Counters counters;
  std::vector<gpu::PassTime> passes;
};

inline double number(const Counters& c, const std::string& name) { return std::get<double>(c.at(name)); }

class Stage {
 public:
  Stage(Frame f, int width, int height) : frame(std::move(f)), passes(device()), view(device(), width, height) {
    geometry.update(device(), frame, passes);
    view.render(frame, geometry, passes);
    passes.take_times();
    // Techniques that are not sampled are judged at the light's centre.
    hard = frame.light.is_area() ? with_size(frame.light, 0) : frame.light;
    light_samples = make_light_samples(hard, {1, 1});
    the_case = {&device(), &frame, &geometry, &light_samples, width, height};
    visibility = gpu::Buffer(device(), sizeof(float) * pixels(), gpu::Memory::device, "visibility");
  }
  ~Stage() {
    EXPECT_TRUE(device().validation_enabled());
    EXPECT_TRUE(device().validation_messages().empty()) << device().validation_messages().front();
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  std::size_t pixels() const { return view.host().pixel_count(); }

  std::unique_ptr<Technique> make(const ParamValues& given) {
    const TechniqueInfo info = alias_free_shadow_map_technique();
    std::unique_ptr<Technique> technique = info.make(resolve(info.params, given, "test"));
    const std::optional<std::string> reason = technique->supports(the_case);
    EXPECT_FALSE(reason.has_value()) << *reason;
    technique->setup(the_case, passes);
    technique->build(the_case, passes);
    passes.take_times();
    return technique;
  }
  Rendered render(Technique& technique) {
    RenderInput in;
    in.scene_case = &the_case, in.view_samples = &view, in.device.visibility = &visibility;
    technique.render(in, passes);
    Rendered r;
    r.passes = passes.take_times();
    r.visibility.resize(pixels());
    gpu::download(passes, "download", visibility, r.visibility.data(), sizeof(float) * pixels());
    passes.take_times();
    r.counters = technique.counters();
    return r;
  }
  Rendered render(const ParamValues& given = {}) { return render(*make(given)); }

  const MatchedReference& reference(ReferenceOrigin origin = ReferenceOrigin::exact) {
    auto& r = references_[origin == ReferenceOrigin::exact];
    if (!r)
      r = std::make_unique<MatchedReference>(
          ReferenceScene(frame.geometry).matched(view.host(), hard, light_samples, origin));
    return *r;
  }
  testing::Differences differences(const Rendered& r, ReferenceOrigin origin = ReferenceOrigin::exact) {
    std::vector<uint32_t> mask(pixels());
    for (std::size_t i = 0; i < pixels(); ++i) {
      EXPECT_TRUE(!reference(origin).evaluated[i] || r.visibility[i] == 0 || r.visibility[i] == 1);
      mask[i] = r.visibility[i] == 0;
    }
    if (!oracle_) oracle_ = std::make_unique<testing::BruteForce>(frame.geometry);
    return testing::explain_differences(*oracle_, hard, light_samples, view.host(), mask, reference(origin).mask,
                                        reference(origin).evaluated, origin == ReferenceOrigin::exact);
  }
  // Differs from Embree in at most 1e-4 of the evaluated pixels, each of them a tie in double precision.
  void expect_exact(const Rendered& r, ReferenceOrigin origin = ReferenceOrigin::exact) {
    const testing::Differences d = differences(r, origin);
    EXPECT_LE(double(d.differing), 1e-4 * double(d.bits)) << d.differing << " of " << d.bits;
    EXPECT_EQ(d.unexplained, 0U) << "worst " << d.worst << " tolerances";
    double shadowed = 0;
    for (std::size_t i = 0; i < pixels(); ++i) shadowed += reference(origin).visibility[i] == 0;
    EXPECT_GT(shadowed, 0.01 * double(d.bits));
  }

  Frame frame;
  gpu::PassRecorder passes;
  GeometryOnDevice geometry;
  ViewSamples view;
  Light hard;
  LightSamples light_samples;
  Case the_case;
  gpu::Buffer visibility;

 private:
  std::unique_ptr<MatchedReference> references_[2];
  std::unique_ptr<testing::BruteForce> oracle_;
};

// Of the scenes of configs/scenes.
inline Frame scene_frame(const std::string& name, const std::string& light, const std::string& camera = "") {
  return Scene::load(name, {"configs/scenes"}).frame(0, light, camera, -1);
}

}  // namespace penumbra::test
