// techniques/common/prefix_scan against sums on the host.
#include "techniques/common/prefix_scan.h"

#include <algorithm>

#include "tests/support/stage.h"

namespace penumbra::testing {
namespace {

struct Scanned {
  std::vector<uint32_t> sums;
  uint64_t total = 0;
};

Scanned scan(const std::vector<uint32_t>& values, uint32_t divisor) {
  gpu::PassRecorder passes(device());
  PrefixScan scan;
  scan.setup(device(), std::min(device().caps().subgroup_size, 32U), divisor);
  const auto count = static_cast<uint32_t>(values.size());
  const auto make = [](std::size_t bytes) {
    return gpu::Buffer(device(), bytes, gpu::Memory::device, "prefix sums");
  };
  const gpu::Buffer in = make(4 * values.size()), out = make(4 * values.size());
  const gpu::Buffer scratch = make(scan.scratch_bytes(count));
  gpu::upload(passes, "upload", in, values.data(), 4 * values.size());
  passes.device_pass("scan", [&](gpu::Commands& c) { scan.record(c, in, out, scratch, count); });
  Scanned s{std::vector<uint32_t>(values.size())};
  uint32_t words[2];
  gpu::download(passes, "download", out, s.sums.data(), 4 * values.size());
  gpu::download(passes, "download", scratch, words, sizeof words);
  s.total = PrefixScan::total(words);
  return s;
}

class PrefixScanOf : public ::testing::TestWithParam<uint32_t> {};

TEST_P(PrefixScanOf, EqualsSumsOnTheHost) {
  std::vector<uint32_t> values(GetParam());
  uint32_t state = 7;
  for (uint32_t& v : values) v = (state = state * 1664525U + 1013904223U) >> 20;
  for (const uint32_t divisor : {1U, 3U}) {
    const Scanned s = scan(values, divisor);
    uint64_t sum = 0;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      wrong += s.sums[i] != static_cast<uint32_t>(sum);
      sum += (values[i] + divisor - 1) / divisor;
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_EQ(s.total, sum);
  }
  EXPECT_TRUE(device().validation_messages().empty()) << device().validation_messages().front();
}

// The sizes between which blocks change, and more values than 16,384 blocks of 32 per lane hold for 32 lanes.
INSTANTIATE_TEST_SUITE_P(Sizes, PrefixScanOf,
                         ::testing::Values(1, 2, 255, 256, 257, 65537, 4194304, 4194561, 20000001));

}  // namespace
}  // namespace penumbra::testing
