#include "compare/pool.h"

#include <fmt/format.h>

#include <unordered_map>

#include "compare/significance.h"
#include "core/error.h"
#include "core/machine.h"

namespace penumbra::compare {
namespace {

using nlohmann::json;

bool is_stat(const json& value) {
  return value.is_object() && value.contains("samples") && value.at("samples").is_array();
}

// The STATs of the same name in all points as one. Runs that lack it, or have no sample, give none.
json pooled_stat(const std::vector<const json*>& stats) {
  std::vector<double> medians;
  for (const json* stat : stats)
    if (is_stat(*stat) && !stat->at("samples").empty())
      medians.push_back(median(stat->at("samples").get<std::vector<double>>()));
  return {{"median", medians.empty() ? 0 : median(medians)}, {"samples", medians}};
}

// Goes down the first timing's objects to its STATs.
json pooled_timing(const std::vector<const json*>& timings) {
  static const json nothing = json::object();
  json out = json::object();
  for (const auto& [name, value] : timings.front()->items()) {
    std::vector<const json*> members;
    for (const json* timing : timings)
      members.push_back(timing->is_object() && timing->contains(name) ? &timing->at(name) : &nothing);
    if (is_stat(value))
      out[name] = pooled_stat(members);
    else if (value.is_object())
      out[name] = pooled_timing(members);
  }
  return out;
}

json pooled_point(const std::vector<const json*>& points) {
  for (const json* point : points)
    if (point->at("status") != "ok") return *point;
  json out = *points.front();
  std::vector<const json*> timings;
  for (const json* point : points) timings.push_back(&point->at("timing"));
  out["timing"] = pooled_timing(timings);
  std::vector<double> others;
  for (const json* point : points)
    if (const auto share = point->find("other_programs"); share != point->end() && share->is_number())
      others.push_back(*share);
  if (!others.empty()) out["other_programs"] = median(others);
  return out;
}

void check_same(const RunResults& a, const RunResults& b) {
  if (a.run.value("config", json()) != b.run.value("config", json()))
    throw InputError(fmt::format("{} and {} are runs of different configs.", a.name, b.name));
  const json left = machine_of(a.run), right = machine_of(b.run);
  if (left != right)
    throw InputError(fmt::format("{} and {} were measured on different machines: {}.", a.name, b.name,
                                 machine_difference(left, right)));
}

}  // namespace

RunResults pool(const std::vector<RunResults>& runs) {
  RunResults out = runs.front();
  std::vector<std::unordered_map<std::string, const json*>> by_identity;
  for (const RunResults& run : runs) {
    check_same(runs.front(), run);
    auto& points = by_identity.emplace_back();
    for (const json& point : run.points) points[identity(point)] = &point;
    if (!run.run.value("complete", true)) out.run["complete"] = false;
  }
  for (json& point : out.points) {
    std::vector<const json*> same;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const auto it = by_identity[i].find(identity(point));
      if (it == by_identity[i].end())
        throw InputError(fmt::format("{} has no point {}, which {} has.", runs[i].name,
                                     point.value("key", point.at("id").get<std::string>()), runs[0].name));
      same.push_back(it->second);
    }
    point = pooled_point(same);
  }
  return out;
}

}  // namespace penumbra::compare
