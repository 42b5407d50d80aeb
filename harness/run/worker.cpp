#include "run/worker.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "core/hash.h"
#include "core/parallel.h"
#include "gpu/device.h"
#include "run/batch.h"
#include "run/provenance.h"
#include "run/worker_process.h"

namespace penumbra::run {
namespace {

void send_event(const nlohmann::json& event) {
  const std::string line = dump_line(event) + '\n';
  for (std::size_t at = 0; at < line.size();) {
    const ssize_t n = ::write(worker_events_fd, line.data() + at, line.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);  // nobody listens any more
    at += static_cast<std::size_t>(n);
  }
}

const char* clock_name(gpu::Device::Clock clock) {
  return clock == gpu::Device::Clock::timestamps ? "device timestamps" : "host clock around submit and fence";
}

nlohmann::json hello(const gpu::Device& device) {
  const gpu::DeviceInfo& info = device.info();
  return {{"event", "hello"},
          {"device",
           {{"name", info.name},
            {"index", info.index},
            {"driver", info.driver},
            {"driver_version", info.driver_version},
            {"api_version", info.api_version},
            {"software", info.software},
            {"clock", clock_name(device.clock())},
            {"subgroup_size", device.caps().subgroup_size},
            {"heap_bytes", device.caps().heap_bytes},
            {"unified_memory", device.caps().unified_memory}}},
          {"threads", thread_count()}};
}

int serve(const Registry& registry, const WorkerSettings& settings, Heartbeat& heartbeat) {
  const double start = now_s();
  std::unique_ptr<gpu::Device> device;
  try {
    device = std::make_unique<gpu::Device>(gpu::DeviceOptions{settings.device, false});
  } catch (const DeviceError& e) {
    send_event({{"event", "no_device"}, {"message", e.what()}});
    return 0;
  }
  Costs costs{{"start", now_s() - start}};
  send_event(hello(*device));
  BatchRunner runner(registry, settings, *device, heartbeat, costs, send_event);
  std::string line;
  try {
    while (std::getline(std::cin, line)) {
      const auto job = nlohmann::json::parse(line);
      std::vector<Point> points;
      for (const auto& p : job.at("points")) points.push_back(point_from_json(p));
      const bool healthy = runner.run(points, job.at("done"));
      send_event({{"event", "batch_done"}});
      if (!healthy) return 1;
    }
  } catch (const WriteError& e) {
    send_event({{"event", "cannot_write"}, {"message", e.what()}});
  }
  return 0;
}

}  // namespace

nlohmann::json to_json(const WorkerSettings& s) {
  std::vector<std::string> search;
  for (const auto& p : s.scene_search) search.push_back(p.string());
  return {{"job", "start"},
          {"device", s.device},
          {"threads", s.threads},
          {"scene_search", search},
          {"run_folder", s.run_folder.string()},
          {"reference_cache", s.reference_cache.string()},
          {"images", s.images},
          {"reference_samples", s.reference_samples},
          {"frames", s.frames},
          {"group_size", s.group_size},
          {"first_call_grace_s", s.first_call_grace_s},
          {"measure",
           {{"warmup", s.measure.warmup},
            {"repetitions", s.measure.repetitions},
            {"min_time_s", s.measure.min_time_s},
            {"max_time_s", s.measure.max_time_s},
            {"target_interval", s.measure.target_interval},
            {"counters", s.measure.counters}}}};
}

WorkerSettings worker_settings_from_json(const nlohmann::json& j) {
  WorkerSettings s;
  s.device = j.at("device");
  s.threads = j.at("threads");
  for (const std::string p : j.at("scene_search")) s.scene_search.emplace_back(p);
  s.run_folder = j.at("run_folder").get<std::string>();
  s.reference_cache = j.at("reference_cache").get<std::string>();
  s.images = j.at("images");
  s.reference_samples = j.at("reference_samples");
  s.frames = j.at("frames");
  s.group_size = j.at("group_size");
  s.first_call_grace_s = j.at("first_call_grace_s");
  const auto& m = j.at("measure");
  s.measure = {m.at("warmup"),     m.at("repetitions"),     m.at("min_time_s"),
               m.at("max_time_s"), m.at("target_interval"), m.at("counters")};
  return s;
}

std::filesystem::path default_cache_folder() {
  const auto folder = [](const char* variable) -> std::filesystem::path {
    const char* value = std::getenv(variable);
    return value && *value ? value : "";
  };
  if (auto f = folder("PENUMBRA_CACHE"); !f.empty()) return f;
  if (auto f = folder("XDG_CACHE_HOME"); !f.empty()) return f / "penumbra";
  if (auto f = folder("HOME"); !f.empty()) return f / ".cache" / "penumbra";
  return {};
}

int worker_main(const Registry& registry) {
  for (int fd : {worker_events_fd, worker_heartbeat_fd}) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
  std::string line;
  if (!std::getline(std::cin, line)) return 0;
  const auto settings = worker_settings_from_json(nlohmann::json::parse(line));
  if (settings.threads > 0) set_threads(settings.threads);
  Heartbeat heartbeat(worker_heartbeat_fd);
  const int code = serve(registry, settings, heartbeat);
  // Everything of worth has been sent; drivers that hang or crash in their exit handlers are not waited for.
  std::cerr.flush();
  ::_exit(code);
}

}  // namespace penumbra::run
