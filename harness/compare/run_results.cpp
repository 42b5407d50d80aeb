#include "compare/run_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "compare/pool.h"
#include "core/error.h"
#include "core/machine.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  std::error_code error;
  if (!in || fs::is_directory(path, error))
    throw InputError(fmt::format("{}: cannot be read.", path.string()));
  return text;
}

json parse_file(const fs::path& path) {
  const std::string text = read_file(path);
  try {
    return json::parse(text);
  } catch (const json::exception& e) {  // also numbers beyond what a double holds
    throw InputError(fmt::format("{}: not JSON: {}", path.string(), e.what()));
  }
}

using Is = bool (json::*)() const noexcept;

// Members that may be absent, but when there, are of this type. The first that is not, or nothing.
std::string wrong_member(const json& object, std::initializer_list<const char*> names, Is is,
                         const char* type) {
  for (const char* name : names)
    if (object.contains(name) && !(object.at(name).*is)()) return fmt::format("'{}' is no {}", name, type);
  return "";
}

// Why a value is no point's record; empty when it is one.
std::string no_record(const json& r) {
  if (!r.is_object()) return "not an object";
  for (const char* key : {"id", "technique", "scene", "status"})
    if (!r.contains(key) || !r.at(key).is_string()) return fmt::format("'{}' is no string", key);
  if (!r.contains("params") || !r.at("params").is_object()) return "'params' is no object";
  if (!r.contains("frame") || !(r.at("frame").is_null() || r.at("frame").is_number_integer()))
    return "'frame' is neither null nor an integer";
  return wrong_member(r, {"key", "message", "machine"}, &json::is_string, "string");
}

// Why a value is no run's header; empty when it is one.
std::string no_header(const json& run) {
  if (!run.is_object()) return "not an object";
  for (const std::string& wrong : {wrong_member(run, {"name", "shard"}, &json::is_string, "string"),
                                   wrong_member(run, {"complete"}, &json::is_boolean, "boolean"),
                                   wrong_member(run, {"machines", "machine"}, &json::is_object, "object"),
                                   wrong_member(run, {"scenes"}, &json::is_array, "array")})
    if (!wrong.empty()) return wrong;
  const json scenes = run.value("scenes", json::array());
  for (const json& scene : scenes)
    if (!scene.is_object() ||
        !wrong_member(scene, {"name", "content_hash"}, &json::is_string, "string").empty())
      return "'scenes' has an entry without its strings";
  return "";
}

void check_header(const json& run, const fs::path& path) {
  if (const std::string why = no_header(run); !why.empty())
    throw InputError(fmt::format("{}: not a run's header: {}.", path.string(), why));
}

void check_version(const json& object, const fs::path& path) {
  const json version = object.is_object() ? object.value("schema_version", json()) : json();
  if (version != 1)
    throw InputError(
        fmt::format("{}: /schema_version: found {}, expected 1.", path.string(), version.dump()));
}

RunResults from_document(const fs::path& path) {
  const json document = parse_file(path);
  if (!document.is_object() || !document.contains("points") || !document.at("points").is_array() ||
      !document.value("run", json()).is_object())
    throw InputError(
        fmt::format("{}: found no results, expected an object with run and points.", path.string()));
  check_version(document, path);
  check_header(document.at("run"), path);
  RunResults results{path.string(), document.at("run"), {}, path.parent_path()};
  std::size_t i = 0;
  for (const json& record : document.at("points")) {
    if (const std::string why = no_record(record); !why.empty())
      throw InputError(fmt::format("{}: /points/{}: not a point's record: {}.", path.string(), i, why));
    results.points.push_back(essential(record));
    ++i;
  }
  return results;
}

RunResults from_journal(const fs::path& folder) {
  RunResults results{folder.string(), parse_file(folder / "run.json"), {}, folder};
  check_header(results.run, folder / "run.json");
  check_version(results.run, folder / "run.json");
  std::ifstream in(folder / "points.jsonl", std::ios::binary);
  std::map<std::string, std::size_t> place;
  for (std::string line; std::getline(in, line);) {
    const json record = json::parse(line, nullptr, false);
    if (!no_record(record).empty()) continue;  // torn, or not ours
    const auto [it, fresh] = place.try_emplace(record.at("id"), results.points.size());
    if (fresh)
      results.points.push_back(essential(record));
    else
      results.points[it->second] = essential(record);
  }
  return results;
}

// A folder whose folders are runs of one config.
RunResults from_runs(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (fs::exists(entry.path() / "run.json")) paths.push_back(entry.path());
  if (paths.empty())
    throw InputError(fmt::format(
        "{}: not a run's folder, nor one of runs: no points.jsonl and no results.json.", folder.string()));
  std::ranges::sort(paths);
  std::vector<RunResults> runs;
  for (const fs::path& path : paths) runs.push_back(read_results(path));
  RunResults pooled = pool(runs);
  pooled.name = fmt::format("{} ({} runs)", folder.string(), runs.size());
  return pooled;
}

json stats_only(const json& timing) {
  json out = json::object();
  if (!timing.is_object()) return out;
  for (const char* name : {"frame_ms", "build_ms", "setup_ms", "wall_ms", "cpu_ms", "passes"})
    if (timing.contains(name)) out[name] = timing.at(name);
  return out;
}

void flatten(const std::string& prefix, const json& value, std::map<std::string, json>& out) {
  if (value.is_object()) {
    for (const auto& [name, member] : value.items()) flatten(prefix + '.' + name, member, out);
  } else if (value.is_number() || value.is_null()) {
    out[prefix] = value;
  }
}

bool is_stat(const json& value) {
  return value.is_object() && value.contains("samples") && value.at("samples").is_array() &&
         std::ranges::all_of(value.at("samples"), [](const json& s) { return s.is_number(); });
}

}  // namespace

json RunResults::machine(const json& point) const {
  const std::string own = point.value("machine", "");
  if (!own.empty() && run.contains("machines") && run.at("machines").contains(own))
    return run.at("machines").at(own);
  return run.contains("machine") ? run.at("machine") : machine_of(run);
}

RunResults read_results(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    if (fs::exists(path / "points.jsonl", error)) return from_journal(path);
    if (fs::exists(path / "results.json", error)) return from_document(path / "results.json");
    return from_runs(path);
  }
  if (!fs::exists(path, error))
    throw InputError(fmt::format("{}: no such run or results file.", path.string()));
  return from_document(path);
}

json essential(const json& record) {
  json out;
  for (const char* key :
       {"id", "key", "technique", "scene", "frame", "params", "status", "message", "machine", "other_programs"})
    if (record.contains(key)) out[key] = record.at(key);
  if (record.at("status") != "ok") return out;
  out["timing"] = stats_only(record.value("timing", json()));
  for (const char* group : {"memory", "metrics", "metrics_own", "metrics_matched", "images"})
    if (record.contains(group)) out[group] = record.at(group);
  json counters = json::object();
  if (const auto all = record.find("counters"); all != record.end() && all->is_object())
    for (const auto& [name, value] : all->items())
      if (value.is_number() || value.is_null()) counters[name] = value;
  out["counters"] = counters;
  return out;
}

std::string identity(const json& point) {
  return point.at("technique").get<std::string>() + '\n' + point.at("scene").get<std::string>() + '\n' +
         point.at("frame").dump() + '\n' +
         point.at("params").dump(-1, ' ', false, json::error_handler_t::replace);
}

std::map<std::string, json> figures(const json& point) {
  std::map<std::string, json> out;
  for (const char* group : {"memory", "metrics", "metrics_matched", "counters"})
    if (point.contains(group)) flatten(group, point.at(group), out);
  const json timing = point.value("timing", json::object());
  for (const char* name : {"frame_ms", "build_ms", "setup_ms", "wall_ms", "cpu_ms"})
    if (timing.contains(name) && is_stat(timing.at(name)))
      out[std::string("timing.") + name] = timing.at(name);
  if (timing.contains("passes") && timing.at("passes").is_object())
    for (const auto& [name, stat] : timing.at("passes").items())
      if (is_stat(stat)) out["timing.passes." + name] = stat;
  return out;
}

std::optional<double> number_at(const std::map<std::string, json>& figures, const std::string& name) {
  const auto it = figures.find(name);
  if (it == figures.end() || !it->second.is_number()) return std::nullopt;
  return it->second.get<double>();
}

}  // namespace penumbra::compare
