// Exclusive prefix sums on the device; see shaders/prefix_scan.comp.
#pragma once
#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu/pipeline.h"

namespace penumbra {

class PrefixScan {
 public:
  // Element i counts as ceil(value / divisor).
  void setup(gpu::Device& device, uint32_t lanes, uint32_t divisor = 1);
  // Bytes of scratch for `count` values. Its first two words are, after record(), the total: low 16 bits, and
  // the rest.
  std::size_t scratch_bytes(uint32_t count) const;
  static uint64_t total(const uint32_t* scratch) { return scratch[0] + (uint64_t{scratch[1]} << 16); }
  // `sums` is modulo 2^32: differences of near entries are right where the total is not.
  void record(gpu::Commands& commands, const gpu::Buffer& values, const gpu::Buffer& sums,
              const gpu::Buffer& scratch, uint32_t count) const;

 private:
  uint32_t per_lane(uint32_t count) const;
  uint32_t blocks(uint32_t count) const { return count / (per_lane(count) * lanes_) + 1; }
  gpu::ComputePipeline stages_[3];
  uint32_t lanes_ = 8;
};

}  // namespace penumbra
