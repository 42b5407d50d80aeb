#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "core/error.h"
#include "gpu/pass_recorder.h"
#include "shaders/busy_comp.h"

namespace penumbra::gpu {
namespace {

struct Busy {
  VkDeviceAddress out;
  uint32_t turns, groups;
};

class Passes : public testing::Test {
 protected:
  Device device;
  PassRecorder passes{device};
  ComputePipeline busy{device, busy_comp_spv, sizeof(Busy)};

  // So many groups of 8000 turns that a pass of them takes some milliseconds on this device.
  uint32_t groups_of_milliseconds(const Buffer& out) {
    for (uint32_t groups = 400;; groups *= 2) {
      const auto start = std::chrono::steady_clock::now();
      passes.device_pass("grow", [&](Commands& c) {
        c.dispatch(busy, Busy{out.address(), 8000, groups}, groups);
      });
      passes.take_times();
      const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
      if (wall.count() > 4 || groups > (1U << 26)) return groups;
    }
  }
  void TearDown() override { EXPECT_TRUE(device.validation_messages().empty()); }
};

TEST_F(Passes, AddUpUnderOneNameInOrderOfFirstUse) {
  const Buffer out(device, 256, Memory::device, "out");
  const auto run = [&](Commands& c) { c.dispatch(busy, Busy{out.address(), 10, 1}, 1); };
  passes.device_pass("b", run);
  passes.host_pass("a", [] {});
  passes.device_pass("b", run);
  const std::vector<PassTime> times = passes.take_times();
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0].name, "b");
  EXPECT_EQ(times[1].name, "a");
  EXPECT_TRUE(passes.take_times().empty());
}

TEST_F(Passes, AgreeWithTheWallClock) {
  const Buffer out(device, 256, Memory::device, "out");
  const auto run = [&](Commands& c) { c.dispatch(busy, Busy{out.address(), 8000, 2000}, 2000); };
  passes.device_pass("compile", run);
  passes.take_times();
  const auto start = std::chrono::steady_clock::now();
  passes.device_pass("busy", run);
  passes.host_pass("sleep", [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); });
  double sum = 0;
  for (const PassTime& t : passes.take_times()) sum += t.ms;
  const double wall =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LE(sum, wall);
  EXPECT_GE(sum, 20);
  EXPECT_GE(sum, 0.5 * wall) << "the passes' clock misses most of the work";
}

// Passes of one submission whose loads differ by known factors: a clock that charges one pass's work to
// another, or to none, shows here.
TEST_F(Passes, ChargeEachPassWithItsOwnWork) {
  const Buffer out(device, 256, Memory::device, "out");
  const auto load = [&](uint32_t groups) {
    return [&, groups](Commands& c) { c.dispatch(busy, Busy{out.address(), 8000, groups}, groups); };
  };
  passes.device_pass("compile", load(1));
  passes.take_times();
  const uint32_t some = groups_of_milliseconds(out);
  const auto start = std::chrono::steady_clock::now();
  passes.device_pass("small", load(some));
  passes.device_pass("large", load(10 * some));
  passes.device_pass("middle", load(4 * some));
  const std::vector<PassTime> times = passes.take_times();
  const double wall =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GE(times[0].ms + times[1].ms + times[2].ms, 0.8 * wall);
  EXPECT_GT(times[1].ms, 3 * times[0].ms) << times[0].ms << " " << times[1].ms << " " << times[2].ms;
  EXPECT_GT(times[1].ms, 1.3 * times[2].ms);
  EXPECT_GT(times[2].ms, 1.3 * times[0].ms);
}

// Half-way through its passes a technique fails; what its passes would have used goes with it.
TEST_F(Passes, ForgetWhatNeverRan) {
  const Buffer kept(device, 256, Memory::device, "kept");
  {
    const Buffer gone(device, 256, Memory::device, "gone");
    const auto fails = [&](Commands& c) {
      c.fill(gone, 1);
      throw PointError("half-way");
    };
    passes.device_pass("ran or recorded", [&](Commands& c) { c.fill(gone, 2); });
    EXPECT_THROW(passes.device_pass("fails", fails), PointError);
  }
  passes.abandon();
  EXPECT_TRUE(passes.take_times().empty());
  const uint32_t seven = 7;
  uint32_t back = 0;
  upload(passes, "up", kept, &seven, sizeof seven);
  download(passes, "down", kept, &back, sizeof back);
  EXPECT_EQ(back, 7U);
}

TEST_F(Passes, MoveBytesBothWays) {
  std::vector<uint32_t> in(100000), back(in.size());
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = static_cast<uint32_t>(i * 2654435761U);
  const Buffer buffer(device, in.size() * sizeof(uint32_t), Memory::device, "buffer");
  upload(passes, "up", buffer, in.data(), in.size() * sizeof(uint32_t));
  download(passes, "down", buffer, back.data(), back.size() * sizeof(uint32_t));
  EXPECT_EQ(in, back);
}

// More groups than one row of the dispatch: every one must run exactly once.
TEST_F(Passes, DispatchReachesEveryGroupPastTheRowLimit) {
  constexpr uint32_t groups = 70001;
  const Buffer out(device, groups * 8 * sizeof(float), Memory::device, "out");
  const ComputePipeline count(device, busy_comp_spv, sizeof(Busy));
  passes.device_pass("fill", [&](Commands& c) { c.fill(out, 0); });
  passes.device_pass("count", [&](Commands& c) {
    c.dispatch(count, Busy{out.address(), 1, groups}, groups);
  });
  std::vector<float> values(groups * 8);
  download(passes, "down", out, values.data(), values.size() * sizeof(float));
  std::size_t wrong = 0;
  for (float v : values) wrong += v != 1.0f;
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace penumbra::gpu
