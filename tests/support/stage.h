// One frame on the device and techniques run on it through their contract, with the matched reference beside.
// Header only: a test that includes it links penumbra_techniques and penumbra_reference.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/pass_recorder.h"
#include "reference/reference.h"
#include "technique/technique.h"

namespace penumbra::testing {

inline gpu::Device& device() {
  static gpu::Device d{gpu::DeviceOptions{}};
  return d;
}

inline double number(const Counters& c, const std::string& name) { return std::get<double>(c.at(name)); }

// The light as a hard-shadow technique sees it: at its centre.
inline Light at_its_center(const Light& light) { return light.is_area() ? with_size(light, 0) : light; }

struct Rendered {
  std::vector<float> visibility;
  std::vector<uint32_t> mask;      // empty unless the technique is sampled
  std::vector<uint8_t> evaluated;  // as the technique narrows it; empty = everywhere
  Counters counters;
  std::vector<gpu::PassTime> passes;
};

class Stage {
 public:
  // The light samples are one at the light's centre; a test may put others in their place before it renders.
  Stage(Frame f, int width, int height)
      : frame(std::move(f)), passes(device()), view(device(), width, height) {
    geometry.update(device(), frame, passes);
    view.render(frame, geometry, passes);
    passes.take_times();
    light_samples = make_light_samples(at_its_center(frame.light), {1, 1});
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
  std::size_t mask_words() const { return static_cast<std::size_t>(light_samples.mask_words()); }

  // Parameters resolved, nothing asked or built yet.
  static std::unique_ptr<Technique> make(const TechniqueInfo& info, const ParamValues& given) {
    return info.make(resolve(info.params, given, "test"));
  }
  // Ready to render.
  std::unique_ptr<Technique> built(const TechniqueInfo& info, const ParamValues& given) {
    std::unique_ptr<Technique> technique = make(info, given);
    const std::optional<std::string> reason = technique->supports(the_case);
    EXPECT_FALSE(reason.has_value()) << *reason;
    technique->setup(the_case, passes);
    technique->build(the_case, passes);
    passes.take_times();
    return technique;
  }
  // `sampled`: the technique writes masks.
  Rendered render(Technique& technique, bool sampled = false, bool counted = true) {
    Rendered r;
    r.visibility.resize(pixels());
    if (sampled) r.mask.resize(pixels() * mask_words());
    const std::size_t mask_bytes = sizeof(uint32_t) * r.mask.size();
    if (sampled) gpu::ensure(mask, device(), mask_bytes, gpu::Memory::device, "masks");
    technique.render(input(sampled), passes);
    r.passes = passes.take_times();
    gpu::download(passes, "download", visibility, r.visibility.data(), sizeof(float) * pixels());
    if (sampled) gpu::download(passes, "download", mask, r.mask.data(), mask_bytes);
    passes.take_times();
    if (counted) r.counters = technique.counters();
    r.evaluated = technique.evaluated_mask();
    return r;
  }
  // One frame of a technique that wants its output on the host.
  Rendered render_on_host(Technique& technique) {
    Rendered r;
    r.visibility.resize(pixels());
    r.mask.resize(pixels() * mask_words());
    RenderInput in;
    in.scene_case = &the_case, in.view_samples = &view, in.host = {r.visibility, r.mask};
    technique.render(in, passes);
    r.passes = passes.take_times();
    return r;
  }
  Rendered render(const TechniqueInfo& info, const ParamValues& given) {
    return render(*built(info, given), info.sampled);
  }
  // One frame and nothing else: what may not allocate.
  void render_only(Technique& technique, bool sampled = false) {
    technique.render(input(sampled), passes);
    passes.take_times();
  }

  // Embree at the light samples.
  const MatchedReference& reference(ReferenceOrigin origin) {
    std::unique_ptr<MatchedReference>& r = references_[origin == ReferenceOrigin::exact];
    if (!r) {
      const Light& light = light_samples.count() > 1 ? frame.light : at_its_center(frame.light);
      r = std::make_unique<MatchedReference>(
          ReferenceScene(frame.geometry).matched(view.host(), light, light_samples, origin));
    }
    return *r;
  }

  Frame frame;
  gpu::PassRecorder passes;
  GeometryOnDevice geometry;
  ViewSamples view;
  LightSamples light_samples;
  Case the_case;
  gpu::Buffer visibility, mask;

 private:
  RenderInput input(bool sampled) const {
    RenderInput in;
    in.scene_case = &the_case, in.view_samples = &view;
    in.device = {&visibility, sampled ? &mask : nullptr};
    return in;
  }
  std::unique_ptr<MatchedReference> references_[2];
};

}  // namespace penumbra::testing
