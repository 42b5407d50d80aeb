#include "techniques/sample_based_soft/frame_state.h"

#include <algorithm>

#include "techniques/sample_based_soft/soft_pass.h"

namespace penumbra::sample_based_soft {

void FrameState::set_light(const Case& c, gpu::PassRecorder& passes) {
  device = c.device;
  lanes = std::min(device->caps().subgroup_size, 32u);
  width = static_cast<uint32_t>(c.width);
  height = static_cast<uint32_t>(c.height);
  light = light_setup(c.frame->light, *c.light_samples, c.frame->geometry.bounds,
                      params.half_spaces == Params::HalfSpaces::table);
  const std::size_t bytes = light.samples.size() * sizeof(Vec4f);
  gpu::ensure(light_samples, *device, bytes, gpu::Memory::device, "the light samples");
  gpu::upload(passes, "upload_light", light_samples, light.samples.data(), bytes);
  sample_texels.ensure(*device, passes, light.samples.size(), "the light samples");
  passes.device_pass("upload_light", [&](gpu::Commands& commands) {
    sample_texels.copy_from(commands, light_samples, light.samples.size());
  });
  if (light.layout.clustered) {
    gpu::ensure(places, *device, light.places.size() * 4, gpu::Memory::device, "places of the light samples");
    gpu::upload(passes, "upload_light", places, light.places.data(), light.places.size() * 4);
  }
  if (light.layout.weighted) {
    const std::vector<float>& w = c.light_samples->weights;
    gpu::ensure(weights, *device, w.size() * 4, gpu::Memory::device, "the light samples' weights");
    gpu::upload(passes, "upload_light", weights, w.data(), w.size() * 4);
  }
  gpu::ensure(frame, *device, sizeof(FrameConstants), gpu::Memory::device, "the frame's constants");
  gpu::ensure(header, *device, sizeof(Header), gpu::Memory::device, "counts");
  gpu::ensure(header_host, *device, sizeof(Header), gpu::Memory::read_back, "counts");
  frame_texels.ensure(*device, passes, sizeof(FrameConstants) / sizeof(Vec4f), "the frame's constants");
  view_texels.ensure(*device, passes, pixels());
  if (transparent())
    gpu::ensure(through, *device, std::size_t{pixels()} * 4, gpu::Memory::device,
                "what transparent triangles let through");
  if (!light.layout.packed)
    gpu::ensure(walked, *device, std::size_t{pixels()} * static_cast<std::size_t>(light.layout.words) * 4,
                gpu::Memory::device, "the masks as walked");
}

bool FrameState::walk_resolves() const {
  const MaskLayout& m = light.layout;
  return m.packed && !m.weighted && m.samples % 32 == 0 && words_per_pass(m) == m.words && !transparent();
}

uint64_t FrameState::masks_address(const RenderInput& in) const {
  return light.layout.packed ? in.device.mask->address() : walked.address();
}

void FrameState::begin(const RenderInput& in, gpu::PassRecorder& passes) {
  passes.device_pass("begin", [&](gpu::Commands& commands) {
    commands.update(frame, &light.constants, sizeof light.constants);
    commands.fill(header, 0);
    const gpu::Buffer& masks = light.layout.packed ? *in.device.mask : walked;
    // Pixels that no light sample reaches are in no list: all is blocked.
    commands.fill(masks, 0xffffffffU, 0, uint64_t{pixels()} * static_cast<uint64_t>(light.layout.words) * 4);
    if (walk_resolves()) commands.fill(*in.device.visibility, 0, 0, uint64_t{pixels()} * 4);
    if (transparent()) commands.fill(through, 0, 0, uint64_t{pixels()} * 4);
    commands.barrier();
    commands.fill(header, 0xffffffffU, offsetof(Header, lo), 5 * 4);
    frame_texels.copy_from(commands, frame, sizeof(FrameConstants) / sizeof(Vec4f));
    view_texels.copy_from(commands, *in.view_samples, pixels());
  });
}

Header FrameState::read_header(gpu::PassRecorder& passes) {
  passes.device_pass("read_counts",
                     [&](gpu::Commands& commands) { commands.copy(header, header_host, sizeof(Header)); });
  passes.finish();
  return header_host.view<Header>()[0];
}

uint64_t FrameState::bytes() const {
  uint64_t sum = view_texels.bytes();
  for (const TexelArray* t : {&frame_texels, &sample_texels}) sum += t->bytes();
  for (const gpu::Buffer* b :
       {&frame, &header, &header_host, &light_samples, &weights, &walked, &through, &places})
    sum += b->bytes();
  return sum;
}

}  // namespace penumbra::sample_based_soft
