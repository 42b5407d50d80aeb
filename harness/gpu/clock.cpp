// Can the device's timestamps be trusted? Lavapipe's around compute work say 0.1 ms for 75 ms.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "gpu/commands.h"
#include "gpu/instance.h"
#include "shaders/clock_probe_comp.h"

namespace penumbra::gpu {
namespace {

struct Push {
  VkDeviceAddress sink;
  uint32_t turns, groups;
};

struct Reading {
  double device_ms, host_ms;
};

Reading time_load(Device& device, const ComputePipeline& pipeline, const Buffer& sink, VkQueryPool queries,
                  uint32_t groups) {
  VkCommandBuffer handle = device.allocate_commands();
  VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  check(vkBeginCommandBuffer(handle, &begin), "clock probe");
  vkCmdResetQueryPool(handle, queries, 0, 2);
  vkCmdWriteTimestamp2(handle, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries, 0);
  Commands commands(device, handle);
  commands.dispatch(pipeline, Push{sink.address(), 4000, groups}, groups);
  commands.barrier();
  vkCmdWriteTimestamp2(handle, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries, 1);
  check(vkEndCommandBuffer(handle), "clock probe");
  const auto start = std::chrono::steady_clock::now();
  device.submit_and_wait(handle);
  const double host =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  std::array<uint64_t, 2> stamps{};
  check(vkGetQueryPoolResults(device.handle(), queries, 0, 2, sizeof stamps, stamps.data(), sizeof(uint64_t),
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "clock probe");
  device.free_commands(handle);
  return {double(stamps[1] - stamps[0]) * double(device.caps().timestamp_period_ns) * 1e-6, host};
}

bool agree(const Reading& r) {
  const double apart = std::abs(r.host_ms - r.device_ms);
  return apart < 0.2 * r.host_ms || (r.device_ms > 1 && apart < 0.2);
}

}  // namespace

Device::Clock probe_clock(Device& device) {
  if (device.caps().timestamp_period_ns == 0) return Device::Clock::submit_and_fence;
  // A device that is the host has no clock of its own to gain by. Lavapipe executes dispatches when it meets
  // them but stamps when it flushes, so whether the two agree depends on what else is recorded: a probe can
  // pass by luck.
  if (device.info().software) return Device::Clock::submit_and_fence;
  const ComputePipeline pipeline(device, clock_probe_comp_spv, sizeof(Push));
  const Buffer sink(device, 256, Memory::device, "clock probe");
  VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP, info.queryCount = 2;
  VkQueryPool queries = VK_NULL_HANDLE;
  check(vkCreateQueryPool(device.handle(), &info, nullptr, &queries), "clock probe");
  time_load(device, pipeline, sink, queries, 1);  // compiles
  uint32_t groups = 64;
  Reading r = time_load(device, pipeline, sink, queries, groups);
  while (r.host_ms < 4 && groups < (1U << 24)) {  // grow until the load is milliseconds by the host's clock
    groups *= 4;
    r = time_load(device, pipeline, sink, queries, groups);
  }
  // One reading can be disturbed by other processes; trust needs three in a row.
  bool trusted = agree(r);
  for (int i = 0; trusted && i < 2; ++i) trusted = agree(time_load(device, pipeline, sink, queries, groups));
  vkDestroyQueryPool(device.handle(), queries, nullptr);
  return trusted ? Device::Clock::timestamps : Device::Clock::submit_and_fence;
}

}  // namespace penumbra::gpu
