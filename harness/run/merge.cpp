#include "run/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/machine.h"
#include "image/atomic_file.h"
#include "run/files.h"
#include "run/journal.h"
#include "run/record.h"
#include "run/results.h"

namespace penumbra::run {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

struct Shard {
  fs::path folder;
  json run;
  std::string machine;  // its fingerprint
};

Shard read_shard(const fs::path& folder) {
  const fs::path file = folder / "run.json";
  Shard shard{folder, json::parse(read_text(file), nullptr, false), ""};
  if (!shard.run.is_object() || shard.run.value("schema_version", 0) != schema_version)
    throw InputError(
        fmt::format("{}: not a run's header of schema version {}.", file.string(), schema_version));
  if (!shard.run.value("complete", false))
    throw InputError(
        fmt::format("{}: the run is unfinished; `penumbra run ... --out {} --resume` goes on with it.",
                    folder.string(), folder.string()));
  if (shard.run.contains("merged"))
    throw InputError(fmt::format("{}: was merged already; give the shards themselves.", folder.string()));
  shard.machine = machine_fingerprint(machine_of(shard.run));
  return shard;
}

void check_same(const Shard& a, const Shard& b) {
  for (const char* part : {"name", "config", "program", "embree"}) {
    const json left = a.run.value(part, json()), right = b.run.value(part, json());
    if (left == right) continue;
    throw InputError(
        fmt::format("{} and {} differ in {}: {}. Only shards of one config, run by one program, are joined.",
                    a.folder.string(), b.folder.string(), part,
                    machine_difference(json{{part, left}}, json{{part, right}})));
  }
}

// "2/8" of every run, if any run is a shard.
void check_shards(const std::vector<Shard>& shards) {
  std::map<int, fs::path> seen;
  int count = 0;
  for (const Shard& s : shards) {
    const std::string text = s.run.value("shard", "");
    int index = 0, of = 0;
    if (text.empty()) continue;
    if (std::sscanf(text.c_str(), "%d/%d", &index, &of) != 2 || index < 1 || index > of)
      throw InputError(
          fmt::format("{}: /shard: found '{}', expected I/N.", (s.folder / "run.json").string(), text));
    if (count && of != count)
      throw InputError(fmt::format("{} is shard {}, but others are of {}.", s.folder.string(), text, count));
    count = of;
    if (const auto [it, fresh] = seen.emplace(index, s.folder); !fresh)
      throw InputError(
          fmt::format("shard {} is there twice: {} and {}.", text, it->second.string(), s.folder.string()));
  }
  std::vector<int> missing;
  for (int i = 1; i <= count; ++i)
    if (!seen.contains(i)) missing.push_back(i);
  if (!missing.empty())
    throw InputError(fmt::format("of {} shards these are missing: {}.", count, fmt::join(missing, ", ")));
}

// Where something stands in the config's list; the list's end when it does not.
std::size_t place_in(const json& config, const char* list, const std::string& name) {
  const json all = config.is_object() ? config.value(list, json::array()) : json::array();
  for (std::size_t i = 0; i < all.size(); ++i)
    if ((all[i].is_object() ? all[i].value("technique", json()) : all[i]) == name) return i;
  return all.size();
}

// All records, each with its machine; by scene and technique in the config's order, then by key.
std::vector<json> joined_points(const std::vector<Shard>& shards) {
  std::vector<json> points;
  std::map<std::string, fs::path> owner;
  for (const Shard& s : shards)
    for_each_point(s.folder, [&](const json& record) {
      const std::string id = record.at("id");
      if (const auto [it, fresh] = owner.emplace(id, s.folder); !fresh)
        throw InputError(fmt::format("the point {} is in {} and in {}.", record.value("key", id),
                                     it->second.string(), s.folder.string()));
      points.push_back(record);
      points.back()["machine"] = s.machine;
    });
  const json config = shards.front().run.value("config", json());
  const auto order = [&](const json& p) {
    return std::tuple(place_in(config, "scene", p.value("scene", "")),
                      place_in(config, "techniques", p.value("technique", "")), p.value("key", ""));
  };
  std::vector<std::pair<decltype(order(json())), std::size_t>> keys;
  for (std::size_t i = 0; i < points.size(); ++i) keys.emplace_back(order(points[i]), i);
  std::ranges::sort(keys);
  std::vector<json> sorted;
  for (const auto& [key, i] : keys) sorted.push_back(std::move(points[i]));
  return sorted;
}

void join_scenes(json& out, const Shard& shard) {
  for (const json& scene : shard.run.value("scenes", json::array())) {
    const auto known = std::ranges::find_if(
        out, [&](const json& s) { return s.value("name", "") == scene.value("name", ""); });
    if (known == out.end())
      out.push_back(scene);
    else if (known->value("content_hash", "") != scene.value("content_hash", ""))
      throw InputError(fmt::format("{}: scene {} had another content there than in the shards before.",
                                   shard.folder.string(), scene.value("name", "")));
  }
}

json joined_header(const std::vector<Shard>& shards, std::size_t points) {
  json run = shards.front().run;
  for (const char* own : {"shard", "former_starts", "command_line"}) run.erase(own);
  run["points"] = points;
  run["machines"] = json::object(), run["merged"] = json::array();
  run["scenes"] = json::array(), run["cost_s"] = json::object();
  for (const Shard& s : shards) {
    run["machines"][s.machine] = machine_of(s.run);
    join_scenes(run["scenes"], s);
    json own = {{"machine", s.machine}};
    for (const char* key :
         {"shard", "started", "ended", "load", "load_at_end", "cost_s", "os", "command_line"})
      if (s.run.contains(key)) own[key] = s.run.at(key);
    run["merged"].push_back(own);
    run["started"] = std::min(run.value("started", ""), s.run.value("started", ""));
    run["ended"] = std::max(run.value("ended", ""), s.run.value("ended", ""));
    const json costs = s.run.value("cost_s", json::object());
    for (const auto& [name, seconds] : costs.items())
      run["cost_s"][name] = run["cost_s"].value(name, 0.0) + seconds.get<double>();
  }
  return run;
}

// Pictures are named by what they show: those of one name are equal. Links where the file system can.
void join_images(const std::vector<Shard>& shards, const fs::path& out) {
  for (const Shard& s : shards) {
    const fs::path from = s.folder / "images";
    if (!fs::exists(from)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(from)) {
      if (!entry.is_regular_file()) continue;
      const fs::path to = out / "images" / entry.path().lexically_relative(from);
      if (fs::exists(to)) continue;
      make_folder(to.parent_path());
      std::error_code error;
      fs::create_hard_link(entry.path(), to, error);
      if (error) fs::copy_file(entry.path(), to, error);
      if (error) throw WriteError(fmt::format("{}: cannot be written: {}", to.string(), error.message()));
    }
  }
}

}  // namespace

MergeOutcome merge_runs(const std::vector<fs::path>& runs, const fs::path& out) {
  if (runs.empty()) throw InputError("nothing to merge.");
  std::vector<Shard> shards;
  for (const fs::path& folder : runs) shards.push_back(read_shard(folder));
  for (const Shard& s : shards) check_same(shards.front(), s);
  check_shards(shards);
  const std::vector<json> points = joined_points(shards);
  const json header = joined_header(shards, points.size());
  if (fs::exists(out / "run.json"))
    throw InputError(fmt::format("{}: already holds results; choose another --out.", out.string()));
  make_folder(out);
  join_images(shards, out);
  const RecordSource source = [&](const auto& visit) {
    for (const json& p : points) visit(p);
  };
  AtomicFile journal(out / "points.jsonl"), csv(out / "results.csv");
  for (const json& p : points) {
    const std::string line = dump_line(p) + '\n';
    journal.write(line.data(), line.size());
  }
  journal.commit();
  write_csv(source, [&](const std::string& line) { csv.write(line.data(), line.size()); });
  csv.commit();
  write_results_json(out / "results.json", header, source);
  // Last: without it the folder is no run, and merging again starts over.
  write_text(out / "run.json", header.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
  MergeOutcome outcome;
  outcome.points = points.size();
  outcome.failed = static_cast<std::size_t>(std::ranges::count_if(
      points, [](const json& p) { return p.at("status") != "ok" && p.at("status") != "unsupported"; }));
  for (const auto& [fingerprint, machine] : header["machines"].items())
    outcome.machines.push_back(fingerprint + " " + machine.at("cpu").value("model", json()).dump() + ", " +
                               machine.at("device").value("name", json()).dump());
  return outcome;
}

}  // namespace penumbra::run
