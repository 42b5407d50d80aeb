#include "techniques/common/prefix_scan.h"

#include "shaders/prefix_scan.h"
#include "techniques/common/shaders/constants.h"

namespace penumbra {

void PrefixScan::setup(gpu::Device& device, uint32_t lanes, uint32_t divisor) {
  lanes_ = lanes;
  for (uint32_t stage = 0; stage < 3; ++stage) {
    const gpu::Specialization constants[] = {{0, lanes}, {1, stage}, {2, divisor}};
    stages_[stage] = gpu::ComputePipeline(device, prefix_scan_spv, sizeof(PrefixScanConstants), constants);
  }
}

// One invocation sums up the blocks, in fewer turns than the 65,535 after which some drivers end loops.
uint32_t PrefixScan::per_lane(uint32_t count) const {
  uint32_t values = 32;
  while (count / values / lanes_ > 16384) values *= 2;
  return values;
}

std::size_t PrefixScan::scratch_bytes(uint32_t count) const {
  return (2 + 2 * std::size_t{blocks(count)}) * 4;
}

void PrefixScan::record(gpu::Commands& commands, const gpu::Buffer& values, const gpu::Buffer& sums,
                        const gpu::Buffer& scratch, uint32_t count) const {
  PrefixScanConstants pc{};
  pc.values = values.address();
  pc.sums = sums.address();
  pc.blocks = scratch.address();
  pc.count = count;
  pc.block_count = blocks(count);
  pc.per_lane = per_lane(count);
  for (uint32_t stage = 0; stage < 3; ++stage) {
    commands.dispatch(stages_[stage], pc, stage == 1 ? 1 : pc.block_count);
    commands.barrier();
  }
}

}  // namespace penumbra
