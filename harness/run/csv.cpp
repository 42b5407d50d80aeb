// results.csv: one row per point, one column per number.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "run/results.h"

namespace penumbra::run {
namespace {

using nlohmann::json;

// Columns that every table has, in this order; the others follow by name.
const std::vector<std::string> leading = {
    "id",    "technique", "scene",      "frame",     "status",        "message",       "width", "height",
    "light", "camera",    "light_size", "mask_size", "light_samples", "light_pattern", "seed"};

// RFC 4180: quoted where it must be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

// Null is an empty cell; a list of two numbers is 16x8.
std::string text_of(const json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_array() && value.size() == 2) return text_of(value[0]) + "x" + text_of(value[1]);
  return value.dump();
}

using Row = std::map<std::string, std::string>;

void add_stat(Row& row, const std::string& name, const json& stat) {
  if (!stat.is_object()) return;
  for (const char* part : {"median", "mean", "min", "p95"}) row[name + "_" + part] = text_of(stat.at(part));
  row[name + "_ci95_lo"] = text_of(stat.at("ci95")[0]);
  row[name + "_ci95_hi"] = text_of(stat.at("ci95")[1]);
  row[name + "_samples"] = std::to_string(stat.at("samples").size());
}

// Scalars of an object and of its objects, as prefix.name; lists are left to results.json.
void add_scalars(Row& row, const std::string& prefix, const json& object) {
  if (!object.is_object()) return;
  for (const auto& [name, value] : object.items()) {
    if (value.is_object())
      add_scalars(row, prefix + "." + name, value);
    else if (!value.is_array())
      row[prefix + "." + name] = text_of(value);
  }
}

Row row_of(const json& point) {
  Row row;
  for (const char* name : {"id", "technique", "scene", "frame", "status", "message"})
    if (point.contains(name)) row[name] = text_of(point[name]);
  const json params = point.value("params", json::object()), timing = point.value("timing", json::object());
  const json passes = timing.value("passes", json::object());
  for (const auto& [name, value] : params.items()) {
    if (name == "resolution")
      row["width"] = text_of(value[0]), row["height"] = text_of(value[1]);
    else if (std::ranges::find(leading, name) != leading.end())
      row[name] = text_of(value);
    else
      row["param." + name] = text_of(value);
  }
  for (const char* name : {"frame_ms", "build_ms", "wall_ms", "cpu_ms"})
    if (timing.contains(name)) add_stat(row, name, timing[name]);
  if (timing.contains("setup_ms")) row["setup_ms"] = text_of(timing["setup_ms"]["median"]);
  for (const auto& [name, stat] : passes.items()) row["pass." + name + "_ms"] = text_of(stat.at("median"));
  add_scalars(row, "memory", point.value("memory", json()));
  add_scalars(row, "metrics", point.value("metrics", json()));
  add_scalars(row, "metrics_own", point.value("metrics_own", json()));
  add_scalars(row, "metrics_matched", point.value("metrics_matched", json()));
  add_scalars(row, "counters", point.value("counters", json()));
  return row;
}

std::string line(const std::vector<std::string>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) text += (i ? "," : "") + cell(cells[i]);
  return text + "\r\n";
}

}  // namespace

void write_csv(const RecordSource& source, const std::function<void(const std::string&)>& write) {
  std::set<std::string> others;
  source([&](const json& point) {
    for (const auto& [name, value] : row_of(point))
      if (std::ranges::find(leading, name) == leading.end()) others.insert(name);
  });
  std::vector<std::string> columns = leading;
  columns.insert(columns.end(), others.begin(), others.end());
  write(line(columns));
  source([&](const json& point) {
    const Row row = row_of(point);
    std::vector<std::string> cells;
    for (const std::string& column : columns) {
      const auto it = row.find(column);
      cells.push_back(it == row.end() ? "" : it->second);
    }
    write(line(cells));
  });
}

}  // namespace penumbra::run
