#include "techniques/alias_free_shadow_map/sample_lists.h"

#include <algorithm>

#include "shaders/alias_free_bin_samples.h"

namespace penumbra::alias_free {

void SampleLists::setup(const Case& c) {
  gpu::Device& device = *c.device;
  const auto make = [&](uint32_t stage, uint32_t cube) {
    const gpu::Specialization constants[] = {{0, stage}, {1, cube}, {3, at_infinity(c.frame->light)}};
    return gpu::ComputePipeline(device, alias_free_bin_samples_spv, sizeof(BinPush), constants);
  };
  count_[0] = make(0, 0), count_[1] = make(0, 1), fill_ = make(1, 0);
  scan_.setup(device, std::min(device.caps().subgroup_size, 32U));
}

void SampleLists::allocate(gpu::PassRecorder& passes, uint32_t pixels) {
  gpu::Device& device = passes.device();
  const auto ensure = [&](gpu::Buffer& buffer, std::size_t bytes, const char* what) {
    gpu::ensure(buffer, device, bytes, gpu::Memory::device, what);
  };
  ensure(lengths_, (std::size_t{texels_} + 1) * 4, "lengths of the lists");
  ensure(offsets_, (std::size_t{texels_} + 1) * 4, "offsets of the lists");
  ensure(scratch_, scan_.scratch_bytes(texels_ + 1), "prefix sums");
  ensure(pixel_texels_, std::size_t{pixels} * 4, "texels of the view samples");
  ensure(slots_, std::size_t{pixels} * 4, "places of the view samples");
  ensure(lists_, std::size_t{pixels} * sizeof(Vec4f), "lists of view samples");
  ensure(blocked_, std::size_t{pixels} * 4, "who is in shadow");
  list_texels_.ensure(device, passes, pixels, "lists of view samples", VK_FORMAT_R32G32B32A32_UINT);
}

void SampleLists::run(uint32_t pixels, const LightView& view, const Fitter& fitter, const gpu::Buffer& away,
                      const gpu::Buffer& progress, gpu::PassRecorder& passes) {
  texels_ = view.face_count * view.grid_size * view.grid_size;
  allocate(passes, pixels);
  BinPush push{};
  push.frame = fitter.view_buffer().address();
  push.samples = fitter.samples().address();
  push.away = away.address(), push.progress = progress.address();
  push.lengths = lengths_.address();
  push.offsets = offsets_.address();
  push.texels = pixel_texels_.address();
  push.slots = slots_.address();
  push.lists = lists_.address();
  push.count = pixels;
  constexpr uint32_t per_group = group_lanes * samples_per_lane;
  const uint64_t groups = (uint64_t{pixels} + per_group - 1) / per_group;
  passes.device_pass("count", [&](gpu::Commands& commands) {
    commands.fill(lengths_, 0);
    commands.fill(blocked_, 0);
    commands.fill(progress, 0);
    commands.barrier();
    commands.dispatch(count_[view.face_count > 1], push, groups);
  });
  passes.device_pass("scan", [&](gpu::Commands& commands) {
    scan_.record(commands, lengths_, offsets_, scratch_, texels_ + 1);
  });
  passes.device_pass("fill", [&](gpu::Commands& commands) {
    commands.dispatch(fill_, push, groups);
    commands.barrier();
    list_texels_.copy_from(commands, lists_, pixels);
  });
}

uint64_t SampleLists::list_bytes() const {
  return lengths_.bytes() + offsets_.bytes() + lists_.bytes() + slots_.bytes() + blocked_.bytes();
}

uint64_t SampleLists::bytes() const {
  return list_bytes() + list_texels_.bytes() + scratch_.bytes() + pixel_texels_.bytes();
}

}  // namespace penumbra::alias_free
