// Renders a frame with gears through the technique contract: what its tests and benchmarks share.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/pass_recorder.h"
#include "samples/light_samples.h"
#include "samples/view_samples.h"
#include "scene/scene.h"
#include "technique/technique.h"
#include "techniques/gears/gears.h"

namespace penumbra::testing {

// A frame on the device, its view samples, and a set of light samples.
struct DeviceScene {
  gpu::Device& device;
  gpu::PassRecorder passes;
  Frame frame;
  GeometryOnDevice geometry;
  LightSamples samples;
  std::unique_ptr<ViewSamples> view;
  Case scene_case;

  DeviceScene(gpu::Device& device_, Frame frame_, int width, int height, const LightSampleRequest& request)
      : device(device_), passes(device_), frame(std::move(frame_)) {
    samples = make_light_samples(frame.light, request);
    view = std::make_unique<ViewSamples>(device, width, height);
    update();
    scene_case = {&device, &frame, &geometry, &samples, width, height};
  }
  // After the frame changed.
  void update() {
    geometry.update(device, frame, passes);
    view->render(frame, geometry, passes);
    passes.finish();
  }
};

struct GearsPicture {
  std::vector<float> visibility;
  std::vector<uint32_t> mask;
};

class GearsRun {
 public:
  GearsRun(DeviceScene& scene, const ParamValues& given) : scene_(scene) {
    const TechniqueInfo info = gears_technique();
    const ParamValues params = resolve(info.params, given, "gears");
    technique_ = info.make(params);
    on_host_ = info.residence_with(params) == Residence::host;
    const std::size_t pixels = scene.view->host().pixel_count();
    if (on_host_) {
      host_ = {
          std::vector<float>(pixels, -7.0F),
          std::vector<uint32_t>(pixels * static_cast<std::size_t>(scene.samples.mask_words()), 0xdeadbeefU)};
      build();
      return;
    }
    visibility_ = gpu::Buffer(scene.device, pixels * 4, gpu::Memory::device, "visibility");
    mask_ = gpu::Buffer(scene.device, pixels * static_cast<std::size_t>(scene.samples.mask_words()) * 4,
                        gpu::Memory::device, "masks");
    technique_->setup(scene.scene_case, scene.passes);
    build();
  }
  void build() {
    technique_->build(scene_.scene_case, scene_.passes);
    scene_.passes.finish();
  }
  Technique& technique() { return *technique_; }
  void render() {
    RenderInput in;
    in.scene_case = &scene_.scene_case;
    in.view_samples = scene_.view.get();
    if (on_host_)
      in.host = {host_.visibility, host_.mask};
    else
      in.device = {&visibility_, &mask_};
    technique_->render(in, scene_.passes);
    scene_.passes.finish();
  }
  GearsPicture picture() {
    if (on_host_) return host_;
    const std::size_t pixels = scene_.view->host().pixel_count();
    GearsPicture p{std::vector<float>(pixels),
                   std::vector<uint32_t>(pixels * static_cast<std::size_t>(scene_.samples.mask_words()))};
    gpu::download(scene_.passes, "download", visibility_, p.visibility.data(), p.visibility.size() * 4);
    gpu::download(scene_.passes, "download", mask_, p.mask.data(), p.mask.size() * 4);
    scene_.passes.finish();
    return p;
  }

 private:
  DeviceScene& scene_;
  std::unique_ptr<Technique> technique_;
  bool on_host_ = false;
  gpu::Buffer visibility_, mask_;  // on the device, or
  GearsPicture host_;
};

}  // namespace penumbra::testing
