#include "techniques/alias_free_shadow_map/sample_lists.h"

#include <algorithm>

#include "shaders/alias_free_bin_samples.h"
#include "techniques/alias_free_shadow_map/fitter.h"

namespace penumbra::alias_free {

void SampleLists::setup(const Case& c) {
  gpu::Device& device = *c.device;
  for (uint32_t stage = 0; stage < 2; ++stage) {
    const gpu::Specialization constants[] = {{0, stage}, {3, at_infinity(c.frame->light)}};
    bin_[stage] = gpu::ComputePipeline(device, alias_free_bin_samples_spv, sizeof(BinPush), constants);
  }
  scan_.setup(device, std::min(device.caps().subgroup_size, 32U));
}

void SampleLists::allocate(gpu::Device& device, uint32_t pixels) {
  const auto ensure = [&](gpu::Buffer& buffer, std::size_t bytes, const char* what) {
    gpu::ensure(buffer, device, bytes, gpu::Memory::device, what);
  };
  ensure(lengths_, (std::size_t{texels_} + 1) * 4, "lengths of the lists");
  ensure(offsets_, (std::size_t{texels_} + 1) * 4, "offsets of the lists");
  ensure(scratch_, scan_.scratch_bytes(texels_ + 1), "prefix sums");
  ensure(pixel_texels_, std::size_t{pixels} * 4, "texels of the view samples");
  ensure(slots_, std::size_t{pixels} * 4, "places of the view samples");
  ensure(lists_, std::size_t{pixels} * sizeof(Vec4f), "lists of view samples");
  ensure(blocked_, (std::size_t{pixels} + 31) / 32 * 4, "shadow bits");
}

void SampleLists::run(const RenderInput& in, const LightView& view, const gpu::Buffer& view_buffer,
                      gpu::PassRecorder& passes) {
  const ViewSamples& samples = *in.view_samples;
  const auto pixels = static_cast<uint32_t>(samples.width() * samples.height());
  texels_ = view.face_count * view.grid_size * view.grid_size;
  allocate(passes.device(), pixels);
  BinPush push{};
  push.frame = view_buffer.address();
  push.position = samples.position().address();
  push.origin = segment_origins(params_, samples).address();
  push.normal = samples.geometric_normal().address();
  push.triangle = samples.triangle().address();
  push.lengths = lengths_.address();
  push.offsets = offsets_.address();
  push.texels = pixel_texels_.address();
  push.slots = slots_.address();
  push.lists = lists_.address();
  push.count = pixels;
  const uint64_t groups = (uint64_t{pixels} + group_lanes - 1) / group_lanes;
  passes.device_pass("count", [&](gpu::Commands& commands) {
    commands.fill(lengths_, 0);
    commands.fill(blocked_, 0);
    commands.barrier();
    commands.dispatch(bin_[0], push, groups);
  });
  passes.device_pass("scan", [&](gpu::Commands& commands) {
    scan_.record(commands, lengths_, offsets_, scratch_, texels_ + 1);
  });
  passes.device_pass("fill", [&](gpu::Commands& commands) { commands.dispatch(bin_[1], push, groups); });
}

uint64_t SampleLists::list_bytes() const {
  return lengths_.bytes() + offsets_.bytes() + lists_.bytes() + slots_.bytes() + blocked_.bytes();
}

uint64_t SampleLists::bytes() const { return list_bytes() + scratch_.bytes() + pixel_texels_.bytes(); }

}  // namespace penumbra::alias_free
