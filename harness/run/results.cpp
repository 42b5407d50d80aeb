#include "run/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "image/atomic_file.h"
#include "run/record.h"
#include "run/statistics.h"

namespace penumbra::run {
namespace {

using nlohmann::json;

const std::vector<const char*> mean_metrics = {"mae",  "rmse", "psnr", "ssim",   "flip",
                                               "bias", "acne", "leak", "flicker"};

// Mean over the frames that have a value; null when none has.
json mean_of(const std::vector<json>& frames, const char* group, const char* name) {
  double sum = 0;
  int n = 0;
  for (const json& f : frames) {
    const auto at = f.find(group);
    if (at == f.end() || !at->is_object() || !at->contains(name) || !(*at)[name].is_number()) continue;
    sum += (*at)[name].get<double>();
    ++n;
  }
  return n ? json(sum / n) : json();
}

json max_of(const std::vector<json>& frames, const char* group, const char* name) {
  json max;
  for (const json& f : frames)
    if (const auto at = f.find(group);
        at != f.end() && at->is_object() && at->contains(name) && (*at)[name].is_number())
      max = max.is_null() ? (*at)[name] : json(std::max(max.get<double>(), (*at)[name].get<double>()));
  return max;
}

// The frames' medians as samples: the spread is that of the animation, not of the clock.
json stat_of_medians(const std::vector<json>& frames, const char* name) {
  std::vector<double> medians;
  for (const json& f : frames)
    if (f.contains("timing") && f["timing"].contains(name)) medians.push_back(f["timing"][name]["median"]);
  return medians.empty() ? json() : to_json(summarize(medians));
}

json benchmark_entry(const json& point, const std::string& name, double ms, int repetition,
                     std::size_t repetitions) {
  return {{"name", name},
          {"run_name", name},
          {"run_type", "iteration"},
          {"family_index", 0},
          {"per_family_instance_index", 0},
          {"repetitions", repetitions},
          {"repetition_index", repetition},
          {"threads", 1},
          {"iterations", 1},
          {"real_time", ms},
          {"cpu_time", ms},
          {"time_unit", "ms"},
          {"label", point["id"]}};
}

}  // namespace

RecordSource records(const Journal& journal, std::vector<std::string> ids) {
  return [&journal, ids = std::move(ids)](const std::function<void(const json&)>& visit) {
    for (const std::string& id : ids)
      if (const JournalEntry* entry = journal.find(id)) visit(json::parse(journal.line(*entry)));
  };
}

void write_results_json(const std::filesystem::path& path, const json& run, const RecordSource& source) {
  AtomicFile file(path);
  const auto put = [&](const std::string& text) { file.write(text.data(), text.size()); };
  put(fmt::format("{{\"schema_version\": {},\n\"run\": {},\n\"points\": [", schema_version, dump_line(run)));
  bool first = true;
  source([&](const json& record) {
    put(std::string(first ? "\n" : ",\n") + dump_line(record));
    first = false;
  });
  put("\n]}\n");
  file.commit();
}

std::string summary_id(const Point& any_frame) { return sequence_key(any_frame); }

json sequence_summary(const std::vector<json>& frames) {
  json summary;
  for (const char* key : {"technique", "scene", "params"}) summary[key] = frames.front().at(key);
  for (const char* key : {"title", "caption"})
    if (frames.front().contains(key)) summary[key] = frames.front()[key];
  summary["frame"] = nullptr;
  summary["frames"] = frames.size();
  const auto not_ok = std::ranges::find_if(frames, [](const json& f) { return f.at("status") != "ok"; });
  summary["status"] = not_ok == frames.end() ? json("ok") : not_ok->at("status");
  summary["message"] = not_ok == frames.end() ? std::string()
                                              : fmt::format("frame {}: {}", not_ok->at("frame").get<int>(),
                                                            not_ok->value("message", ""));
  if (not_ok != frames.end()) return summary;
  summary["timing"] = {{"frame_ms", stat_of_medians(frames, "frame_ms")},
                       {"build_ms", stat_of_medians(frames, "build_ms")},
                       {"setup_ms", frames.front()["timing"]["setup_ms"]}};
  json metrics = json::object();
  for (const char* name : mean_metrics) metrics[name] = mean_of(frames, "metrics", name);
  metrics["max"] = max_of(frames, "metrics", "max");
  summary["metrics"] = metrics;
  summary["metrics_matched"] = {
      {"mae", mean_of(frames, "metrics_matched", "mae")},
      {"max", max_of(frames, "metrics_matched", "max")},
      {"pixels_off", mean_of(frames, "metrics_matched", "pixels_off")},
      {"mask_bit_mismatch", mean_of(frames, "metrics_matched", "mask_bit_mismatch")}};
  json memory = json::object();
  for (const char* name : {"device_bytes", "host_peak_bytes", "structure_bytes"})
    memory[name] = max_of(frames, "memory", name);
  summary["memory"] = memory;
  summary["counters"] = json::object();
  summary["images"] = json::object();
  return summary;
}

json google_benchmark_json(const json& run, const RecordSource& source) {
  json out;
  const json cpu = run.value("cpu", json::object());
  out["context"] = {{"date", run.value("started", "")},
                    {"host_name", "penumbra"},
                    {"executable", "penumbra"},
                    {"num_cpus", cpu.value("cores", 1)},
                    {"mhz_per_cpu", 0},
                    {"cpu_scaling_enabled", false},
                    {"caches", json::array()},
                    {"library_build_type", "release"}};
  out["benchmarks"] = json::array();
  source([&](const json& point) {
    if (point.at("status") != "ok" || point.at("frame").is_null()) return;
    const std::string name = point.at("key");
    const auto& samples = point.at("timing").at("frame_ms").at("samples");
    int repetition = 0;
    for (const double ms : samples)
      out["benchmarks"].push_back(benchmark_entry(point, name, ms, repetition++, samples.size()));
  });
  return out;
}

}  // namespace penumbra::run
