#include "techniques/common/mask_resolve.h"

#include "shaders/mask_resolve.h"
#include "techniques/common/shaders/constants.h"

namespace penumbra {
namespace {

constexpr uint32_t lanes = 64;

}  // namespace

void MaskResolve::setup(gpu::Device& device, const MaskLayout& m) {
  const gpu::Specialization constants[] = {{0, lanes},
                                           {1, static_cast<uint32_t>(m.samples)},
                                           {2, static_cast<uint32_t>(m.columns)},
                                           {3, static_cast<uint32_t>(m.pitch)},
                                           {4, static_cast<uint32_t>(m.words)},
                                           {5, m.packed},
                                           {6, m.weighted},
                                           {7, m.clustered}};
  pipeline_ = gpu::ComputePipeline(device, mask_resolve_spv, sizeof(MaskResolveConstants), constants);
  mask_words_ = static_cast<uint32_t>(m.mask_words);
}

void MaskResolve::run(uint64_t walked, uint64_t masks, uint64_t visibility, uint64_t weights, uint32_t pixels,
                      gpu::PassRecorder& passes, uint64_t places) const {
  MaskResolveConstants pc{};
  pc.walked = walked;
  pc.masks = masks;
  pc.visibility = visibility;
  pc.weights = weights;
  pc.places = places;
  pc.pixels = pixels;
  pc.mask_words = mask_words_;
  passes.device_pass("resolve", [&](gpu::Commands& commands) {
    commands.dispatch(pipeline_, pc, (uint64_t{pixels} + lanes - 1) / lanes);
  });
}

}  // namespace penumbra
