#include "compare/baseline.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/machine.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;

// Ten digits are far below the noise of times and keep the committed file small.
json rounded(const json& value) {
  if (value.is_number_float()) return json::parse(fmt::format("{:.10g}", value.get<double>()));
  if (!value.is_structured()) return value;
  json out = value;
  for (json& member : out) member = rounded(member);
  return out;
}

// Baselines are committed without pictures.
json without_images(json point) {
  point.erase("images");
  return point;
}

json header(const json& run) {
  json out;
  for (const char* key : {"name", "config", "program", "embree", "cpu", "memory_bytes", "os", "environment",
                          "vulkan", "clock", "threads", "started", "machines", "complete"})
    if (run.contains(key)) out[key] = run.at(key);
  out["machine"] = machine_of(run);
  out["scenes"] = json::array();
  for (const json& scene : run.value("scenes", json::array()))
    out["scenes"].push_back(
        {{"name", scene.value("name", "")}, {"content_hash", scene.value("content_hash", "")}});
  return out;
}

}  // namespace

std::string baseline_text(const RunResults& results) {
  if (!results.run.value("complete", false))
    throw InputError(fmt::format("{}: the run is unfinished; --resume goes on with it.", results.name));
  if (results.run.contains("shard"))
    throw InputError(fmt::format("{}: holds shard {} only; `penumbra merge` joins shards.", results.name,
                                 results.run.at("shard").dump()));
  std::size_t ok = 0;
  for (const json& point : results.points) {
    const std::string status = point.at("status");
    if (status != "ok" && status != "unsupported")
      throw InputError(fmt::format("{}: point {} is {}: {}", results.name, point.value("key", ""), status,
                                   point.value("message", "")));
    ok += status == "ok";
  }
  if (ok == 0) throw InputError(fmt::format("{}: measured nothing: no point is ok.", results.name));
  std::string text =
      fmt::format("{{\"schema_version\": 1,\n\"run\": {},\n\"points\": [", header(results.run).dump());
  bool first = true;
  for (const json& point : results.points) {
    text += (first ? "\n" : ",\n") + without_images(rounded(point)).dump();
    first = false;
  }
  return text + "\n]}\n";
}

}  // namespace penumbra::compare
