#include "techniques/common/sample_mean.h"

#include "shaders/sample_mean.h"
#include "techniques/common/shaders/constants.h"

namespace penumbra {
namespace {

uint32_t pixels(const Case& c) { return static_cast<uint32_t>(c.width) * static_cast<uint32_t>(c.height); }

}  // namespace

void SampleMean::setup(const Case& c) {
  pipeline_ = gpu::ComputePipeline(*c.device, sample_mean_spv, sizeof(SampleMeanConstants));
  lit_ = gpu::Buffer(*c.device, sizeof(float) * pixels(c), gpu::Memory::device,
                     "visibility of one light sample");
}

void SampleMean::add(const RenderInput& in, int i, gpu::PassRecorder& passes) const {
  const LightSamples& samples = *in.scene_case->light_samples;
  SampleMeanConstants pc{};
  pc.lit = lit_.address();
  pc.visibility = in.device.visibility->address();
  pc.masks = in.device.mask->address();
  pc.pixels = pixels(*in.scene_case);
  pc.light_sample = static_cast<uint32_t>(i);
  pc.mask_words = static_cast<uint32_t>(samples.mask_words());
  pc.weight = samples.weights[static_cast<std::size_t>(i)];
  passes.device_pass("accumulate",
                     [&](gpu::Commands& c) { c.dispatch(pipeline_, pc, (uint64_t{pc.pixels} + 63) / 64); });
}

}  // namespace penumbra
