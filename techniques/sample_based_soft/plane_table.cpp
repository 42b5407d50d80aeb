#include "techniques/sample_based_soft/plane_table.h"

#include <fmt/format.h>

#include "core/error.h"
#include "shaders/sample_based_soft_build_table.h"

namespace penumbra::sample_based_soft {

uint32_t entry_texels(const MaskLayout& layout) { return (static_cast<uint32_t>(layout.words) + 3) / 4; }

void PlaneTable::build(const FrameState& state, gpu::PassRecorder& passes) {
  constexpr VkFormat format = VK_FORMAT_R32G32B32A32_UINT;
  if (state.params.half_spaces != Params::HalfSpaces::table) {
    texels_.ensure(*state.device, passes, 1, "the lookup table", format);
    return;
  }
  const auto size = static_cast<uint32_t>(state.params.table_size),
             per_entry = entry_texels(state.light.layout);
  const uint64_t texels = uint64_t{size} * size * size * per_entry;
  if (texels > 0x7fffffffU)
    throw PointError(
        fmt::format("A lookup table of {0} x {0} x {0} entries for {1} light samples has {2} texels; "
                    "at most 2147483647 are possible.",
                    size, state.light.layout.samples, texels));
  texels_.ensure(*state.device, passes, texels, "the lookup table", format);
  // Made in a buffer of its own, since images are filled from buffers only.
  const gpu::Buffer entries(*state.device, texels * 16, gpu::Memory::device, "the lookup table");
  const gpu::ComputePipeline build(*state.device, sample_based_soft_build_table_spv, sizeof(TableConstants));
  TableConstants pc{};
  pc.samples =
      state.light_samples.address() + static_cast<uint64_t>(state.light.layout.samples) * sizeof(Vec4f);
  pc.table = entries.address();
  pc.sample_count = static_cast<uint32_t>(state.light.layout.samples);
  pc.words = 4 * per_entry;
  pc.entries = size * size * size;
  pc.size = size;
  pc.radius = state.light.radius;
  passes.device_pass("build_table", [&](gpu::Commands& commands) {
    commands.dispatch(build, pc, groups_for(uint64_t{pc.entries} * pc.words, wide_lanes));
    commands.barrier();
    texels_.copy_from(commands, entries, texels);
  });
  passes.finish();
}

}  // namespace penumbra::sample_based_soft
