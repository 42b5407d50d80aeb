#include <gtest/gtest.h>

#include <cstdio>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/device.h"

namespace penumbra::gpu {
namespace {

TEST(Device, OpensWithValidationAndSaysWhichDriverRuns) {
  const Device device;  // a missing driver throws and so fails the test: it is never skipped
  std::printf("[driver] %s, %s %s, Vulkan %s, %s\n", device.info().name.c_str(), device.info().driver.c_str(),
              device.info().driver_version.c_str(), device.info().api_version.c_str(),
              device.clock() == Device::Clock::timestamps ? "timestamps" : "submit and fence");
  EXPECT_TRUE(device.validation_enabled()) << "tests run with PENUMBRA_VALIDATION=1";
  EXPECT_TRUE(device.validation_messages().empty());
  EXPECT_GT(device.caps().subgroup_size, 0U);
}

TEST(Device, NamesWhatThereIsWhenTheNameIsUnknown) {
  try {
    const Device device({.select = "no such device"});
    FAIL() << "an unknown name must be an error";
  } catch (const DeviceError& e) {
    EXPECT_NE(std::string(e.what()).find(list_devices().at(0).name), std::string::npos) << e.what();
  }
}

TEST(Device, CountsBytesOfBuffersAndImages) {
  Device device;
  EXPECT_EQ(device.allocated_bytes(), 0U);
  {
    const Buffer buffer(device, 1 << 20, Memory::device, "test");
    EXPECT_GE(device.allocated_bytes(), 1U << 20);
    const Image image(
        device,
        {.width = 64, .height = 32, .format = VK_FORMAT_R32_UINT, .usage = VK_IMAGE_USAGE_SAMPLED_BIT},
        "test image");
    EXPECT_GE(device.allocated_bytes(), (1U << 20) + 64U * 32U * 4U);
  }
  EXPECT_EQ(device.allocated_bytes(), 0U);
  EXPECT_GE(device.peak_bytes(), 1U << 20);
  EXPECT_TRUE(device.validation_messages().empty());
}

TEST(Device, AnswersAnImpossibleAllocationWithBytesAndName) {
  Device device;
  device.set_memory_limit(1 << 20);
  try {
    const Buffer buffer(device, 8 << 20, Memory::device, "a large list");
    FAIL() << "over the limit";
  } catch (const PointError& e) {
    EXPECT_NE(std::string(e.what()).find("a large list needs 8.0 MiB"), std::string::npos) << e.what();
  }
  EXPECT_EQ(device.allocated_bytes(), 0U);
  EXPECT_TRUE(device.validation_messages().empty());
}

TEST(Buffer, MovesWithoutLosingOrDoublingItsMemory) {
  Device device;
  Buffer a(device, 4096, Memory::device, "a");
  const uint64_t held = device.allocated_bytes();
  Buffer b = std::move(a);
  EXPECT_TRUE(b);
  a = Buffer(device, 4096, Memory::device, "again");
  EXPECT_EQ(device.allocated_bytes(), 2 * held);
  EXPECT_FALSE(ensure(b, device, 100, Memory::device, "b"));
  EXPECT_TRUE(ensure(b, device, 1 << 16, Memory::device, "b"));
  EXPECT_GE(b.bytes(), std::size_t{1} << 16);
}

}  // namespace
}  // namespace penumbra::gpu
