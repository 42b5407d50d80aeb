#include "gpu/pass_recorder.h"

#include <chrono>
#include <cstring>
#include <utility>

#include "core/error.h"

namespace penumbra::gpu {
namespace {

using HostClock = std::chrono::steady_clock;

double ms_since(HostClock::time_point start) {
  return std::chrono::duration<double, std::milli>(HostClock::now() - start).count();
}

constexpr uint32_t max_queries = 1024;  // two per pass of one submission

}  // namespace

struct PassRecorder::Impl {
  Device& device;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkQueryPool queries = VK_NULL_HANDLE;
  bool recording = false;
  std::vector<std::size_t> pending;  // index into times, one per recorded pass with timestamps
  std::vector<PassTime> times;

  explicit Impl(Device& d) : device(d), commands(d.allocate_commands()) {
    if (d.clock() != Device::Clock::timestamps) return;
    VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP, info.queryCount = max_queries;
    check(vkCreateQueryPool(d.handle(), &info, nullptr, &queries), "query pool");
  }
  ~Impl() {
    device.free_commands(commands);
    if (queries) vkDestroyQueryPool(device.handle(), queries, nullptr);
  }

  std::size_t slot(std::string_view name) {
    for (std::size_t i = 0; i < times.size(); ++i)
      if (times[i].name == name) return i;
    times.push_back({std::string(name), 0});
    return times.size() - 1;
  }

  void begin() {
    if (recording) return;
    VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &info), "begin commands");
    if (queries) vkCmdResetQueryPool(commands, queries, 0, max_queries);
    recording = true;
  }

  void stamp() {
    const auto query = static_cast<uint32_t>(2 * pending.size());
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries, query);
  }

  // Ends the command buffer and runs it; returns the host's milliseconds from submit to fence.
  double submit() {
    recording = false;
    check(vkEndCommandBuffer(commands), "end commands");
    const HostClock::time_point start = HostClock::now();
    device.submit_and_wait(commands);
    return ms_since(start);
  }

  void collect() {
    if (pending.empty()) return;
    std::vector<uint64_t> stamps(2 * pending.size());
    check(vkGetQueryPoolResults(device.handle(), queries, 0, static_cast<uint32_t>(stamps.size()),
                                stamps.size() * sizeof(uint64_t), stamps.data(), sizeof(uint64_t),
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "read timestamps");
    const double ms_per_tick = double(device.caps().timestamp_period_ns) * 1e-6;
    for (std::size_t i = 0; i < pending.size(); ++i)
      times[pending[i]].ms += double(stamps[2 * i + 1] - stamps[2 * i]) * ms_per_tick;
    pending.clear();
  }
};

PassRecorder::PassRecorder(Device& device) : impl_(std::make_unique<Impl>(device)) {}
PassRecorder::~PassRecorder() = default;
Device& PassRecorder::device() const { return impl_->device; }

void PassRecorder::device_pass(std::string_view name, const std::function<void(Commands&)>& record) {
  if (on_pass) on_pass(name);
  Impl& s = *impl_;
  const std::size_t slot = s.slot(name);
  if (s.queries && 2 * s.pending.size() + 2 > max_queries) finish();
  s.begin();
  Commands commands(s.device, s.commands);
  if (s.queries) s.stamp();
  try {
    record(commands);
  } catch (...) {
    abandon();
    throw;
  }
  commands.barrier();
  if (s.queries) {
    vkCmdWriteTimestamp2(s.commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, s.queries,
                         static_cast<uint32_t>(2 * s.pending.size() + 1));
    s.pending.push_back(slot);
  } else {
    s.times[slot].ms += s.submit();
  }
}

void PassRecorder::host_pass(std::string_view name, const std::function<void()>& work) {
  finish();
  if (on_pass) on_pass(name);
  const std::size_t slot = impl_->slot(name);
  const HostClock::time_point start = HostClock::now();
  work();
  impl_->times[slot].ms += ms_since(start);
}

void PassRecorder::finish() {
  if (!impl_->recording) return;
  impl_->submit();
  impl_->collect();
}

void PassRecorder::abandon() {
  Impl& s = *impl_;
  if (s.recording) vkResetCommandBuffer(s.commands, 0);
  s.recording = false;
  s.pending.clear();
  s.times.clear();
}

std::vector<PassTime> PassRecorder::take_times() {
  finish();
  return std::exchange(impl_->times, {});
}

void upload(PassRecorder& passes, std::string_view pass, const Buffer& to, const void* data,
            std::size_t bytes) {
  if (bytes > to.bytes()) throw std::logic_error("upload past the end of a buffer");
  if (bytes == 0) return;
  if (to.mapped()) return passes.host_pass(pass, [&] { std::memcpy(to.mapped(), data, bytes); });
  const Buffer staging(passes.device(), bytes, Memory::upload, "staging");
  std::memcpy(staging.mapped(), data, bytes);
  passes.device_pass(pass, [&](Commands& c) { c.copy(staging, to, bytes); });
  passes.finish();
}

void download(PassRecorder& passes, std::string_view pass, const Buffer& from, void* data,
              std::size_t bytes) {
  if (bytes > from.bytes()) throw std::logic_error("download past the end of a buffer");
  if (bytes == 0) return;
  if (from.mapped()) return passes.host_pass(pass, [&] { std::memcpy(data, from.mapped(), bytes); });
  const Buffer staging(passes.device(), bytes, Memory::read_back, "staging");
  passes.device_pass(pass, [&](Commands& c) { c.copy(from, staging, bytes); });
  passes.finish();
  std::memcpy(data, staging.mapped(), bytes);
}

}  // namespace penumbra::gpu
